/// Extracts steady runs from a driving log as rows of surge and turning trials.
#pragma once

#include <string>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Criteria of a steady segment: the part of a stretch of constant commands in which the measured
/// rate neither rises nor falls.
///   - force_left, force_right and steering each stay within `same` of one value;
///   - the first `settling_s` after a change of command are excluded, then further spans of
///     `later_s` until the remainder is steady or shorter than `shortest_s`;
///   - the remainder is steady if a straight line fitted to its rate changes from end to end by
///     less than `drift` of the mean, or by less than three of its standard errors.
/// With |steering| <= straight_rad it is a surge run (rate: speed), else a turning run (rate: yaw
/// rate). Both sides must be driven equally, forward.
struct SteadyRule {
  double same = 1e-3;            ///< >= 0, in F' and in rad of steering: larger for noisy commands
  double settling_s = 1.0;       ///< s, >= 0: longer for vehicles that settle slowly
  double shortest_s = 1.0;       ///< s, > 0: shorter accepts more and less certain segments
  double later_s = 0.25;         ///< s, > 0
  double drift = 0.03;           ///< > 0, fraction of the mean rate: smaller is stricter
  double straight_rad = 0.0087;  ///< rad, > 0: half a degree
};

/// A stretch of a log with steady motion.
struct SteadySegment {
  double begin_s = 0.0;
  double end_s = 0.0;
  int line = 0;            ///< line of its first row
  bool turning = false;    ///< a turning run, else a surge run
  double mean_rate = 0.0;  ///< rad/s of a turning run, m/s of a surge run
  /// Standard error of the mean, in its unit, from the scatter about the straight line. Assumes
  /// independent errors of neighbouring rows.
  double std_error = 0.0;
};

/// Steady segments of a log and the resulting trial rows.
struct SteadyRuns {
  TrialSet<SurgeRow> surge;
  TrialSet<TurningRow> turning;
  std::vector<SteadySegment> segments;
};

/// Adds a note `steady-segment` for each segment.
SteadyRuns steady_runs(const DrivingLog& log, const Vehicle& vehicle, const SteadyRule& rule,
                       std::vector<Finding>& findings);

}  // namespace awmr
