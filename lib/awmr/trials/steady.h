/// Steady runs found in a driving log, as rows of surge and turning trials.
#pragma once

#include <string>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// The rule. A steady segment is the part of a stretch of constant commands in which the measured
/// rate neither rises nor falls:
///   - force_left, force_right and steering each stay within `same` of one value;
///   - the first `settling_s` after a change of command are left out, then `later_s` more at a time
///     until the rest is steady or shorter than `shortest_s`;
///   - a rest is steady where the straight line through its rate rises by less than `drift` of the
///     mean from end to end, or by less than three of its own standard errors.
/// With |steering| <= straight_rad it is a surge run (rate: speed), else a turning run (rate: yaw
/// rate). Both sides have to be driven alike, forward.
struct SteadyRule {
  double same = 1e-3;  ///< F', and rad of steering
  double settling_s = 1.0;
  double shortest_s = 1.0;
  double later_s = 0.25;
  double drift = 0.03;
  double straight_rad = 0.0087;  ///< half a degree
};

struct SteadySegment {
  double begin_s = 0.0;
  double end_s = 0.0;
  int line = 0;  ///< of its first row
  bool turning = false;
  double mean_rate = 0.0;  ///< m/s or rad/s
  double std_error = 0.0;  ///< of the mean, from the scatter about the line, as if white
};

struct SteadyRuns {
  TrialSet<SurgeRow> surge;
  TrialSet<TurningRow> turning;
  std::vector<SteadySegment> segments;
};

/// Adds a note `steady-segment` for each.
SteadyRuns steady_runs(const DrivingLog& log, const Vehicle& vehicle, const SteadyRule& rule,
                       std::vector<Finding>& findings);

}  // namespace awmr
