/// Finds steady parts of a driving log and returns them as rows of surge and turning trials.
#pragma once

#include <string>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Criteria of a steady segment. Its commands are constant, and its rate (the speed of a surge run,
/// the yaw rate of a turning run) neither rises nor falls:
///   - force_left, force_right and steering each stay within 1e-3 (F' or rad) of their first value;
///   - the first `settling_s` after a change of command are cut off, then more pieces of 0.25 s,
///     until the remainder is steady; a remainder shorter than `shortest_s` is dropped;
///   - the remainder is steady if a straight line fitted to its rate (at least five measurements)
///     changes from end to end by at most `drift` of the mean rate, or by at most three standard
///     errors of that change.
/// If the vehicle has steering, the forces left and right must be equal and forward; the segment is
/// a surge run if |steering| <= 0.5 deg, else a turning run. If it has no steering, the segment is
/// a turning run if the forces left and right differ by more than 1e-3. Otherwise it is a surge
/// run, whose forces must be forward. The mean rate must also exceed three standard errors and have
/// the direction of the command.
struct SteadyRule {
  /// Time cut off after a change of command, s, >= 0; increase it for vehicles that settle slowly.
  double settling_s = 1.0;
  /// Shortest segment, s, > 0; decrease it to accept more, less certain segments.
  double shortest_s = 1.0;
  /// Largest accepted change of the rate, as a fraction of its mean, > 0.
  double drift = 0.03;
};

/// Trial rows from the steady segments of a log.
struct SteadyRuns {
  TrialSet<SurgeRow> surge;
  TrialSet<TurningRow> turning;
};

/// Finds the segments of a log that are steady by the default SteadyRule. Adds a note
/// `steady-segment` for each.
SteadyRuns steady_runs(const DrivingLog& log, const Vehicle& vehicle,
                       std::vector<Finding>& findings);

/// Steady speed of a wheel at a constant command.
struct SteadyWheel {
  double command = 0.0;    ///< commanded force of the wheel, F'
  double speed_mps = 0.0;  ///< mean rolling speed; forward positive
  double std_error = 0.0;  ///< standard error of speed_mps, m/s
  bool turning = false;    ///< true: the commands left and right differ
};

/// Returns the steady speeds of the wheels in the segments of the log in which speed and yaw rate
/// are steady (SteadyRule). A segment with equal commands left and right gives one speed, the
/// vehicle's speed u. Other segments give u - d r for the left and u + d r for the right wheels,
/// with the yaw rate r and half the track width d. If the log has no yaw rate, uses only segments
/// with equal commands.
std::vector<SteadyWheel> steady_wheels(const DrivingLog& log, const Vehicle& vehicle,
                                       const SteadyRule& rule);

}  // namespace awmr
