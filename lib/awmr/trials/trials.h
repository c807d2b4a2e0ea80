/// Trials with one row per run, and coast-downs, in SI units. read_trials.h reads them.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/model/state.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// A run at constant tau_speed with d_r = 0, to the steady speed u at which
///   tau_speed = g1(u)                                                            [paper (45)-(46)]
struct SurgeRow {
  int line = 0;                      ///< line in the file
  double tau_speed = 0.0;            ///< 4 F', dimensionless, > 0
  double speed_mps = 0.0;            ///< u, m/s, > 0: printed or timed, as preferred
  std::optional<double> distance_m;  ///< m, > 0; with elapsed_s if the run was timed
  std::optional<double> elapsed_s;   ///< s, > 0
};

/// A run with the same F' on every wheel and a constant d_r, to the steady yaw rate r at which
///   2 l_f F' sin d_r = g3(r)                                                     [paper (61)-(62)]
/// All are magnitudes: g3 is odd, so a turn to the right is mirrored.
///
/// For a differential turn at d_r = 0, as in every run of a vehicle without steering:
///   2 d (F'R - F'L) = g3(r)                                                           [paper (41)]
struct TurningRow {
  int line = 0;                     ///< line in the file
  double steering_rad = 0.0;        ///< d_r, rad, > 0; 0 for differential turns
  double wheel_force = 0.0;         ///< F' of each wheel, over F_max, > 0; 0 for differential turns
  double tau_turn_m = 0.0;          ///< m, > 0: printed if given, else computed from the forces
  double yaw_rate_radps = 0.0;      ///< r, rad/s, > 0: printed or timed, as preferred
  std::optional<double> turns;      ///< full turns, > 0; with elapsed_s if the run was timed
  std::optional<double> elapsed_s;  ///< s, > 0
  /// Differential turns: F' of each left and each right wheel, over F_max, the right one larger.
  std::optional<SideForces<double>> sides = {};
};

/// A timed coast-down: motors off at initial_speed_mps = u_max, at rest after stop_time_s = t_a.
/// stop_time_s() in model/steady.h has the equation.
struct StopTimeRow {
  int line = 0;                    ///< line in the file
  double initial_speed_mps = 0.0;  ///< u_max, m/s, > 0
  double stop_time_s = 0.0;        ///< t_a, s, > 0
  /// s, > 0: standard deviation, from the resolution of the written time
  double timing_std_s = 0.0;
};

/// A recorded coast-down: speed by time, with the motors off from an unknown time on.
struct CoastCurve {
  std::string file;
  int line = 0;  ///< line of its first row
  std::vector<double> t_s;
  std::vector<double> speed_mps;
  std::vector<std::size_t> mapped = {};  ///< indices of the TrialOptions' mappings that were used
  bool of_bins = false;                  ///< from from_mps, to_mps and elapsed_s of every speed bin
};

/// Rows of one file. A row at rest or without force has no logarithm and no information for a power
/// law: it is set aside and counted.                                        [paper (49), corrected]
/// Corrected: (49) prints twelve rows for eleven trials, the first of them the logarithm of zero.
template <class Row>
struct TrialSet {
  std::string file;
  std::vector<Row> rows;
  int set_aside = 0;                     ///< number of rows in the file not in `rows`
  std::vector<std::size_t> mapped = {};  ///< indices of the TrialOptions' mappings that were used
  std::string force_column = {};         ///< source column of the force of a surge or turning run
  std::string rate_column =
      {};  ///< source column of the rate of a turning run: "yaw_rate_radps" or "turns"
  /// Differential turns of a vehicle that also steers. They include tyre scrub, so g3 of steered
  /// turns does not apply. Not in `rows`.
  std::vector<Row> by_sides = {};
  /// Differential runs without rotation: their moment is a lower bound of the tyres' static moment.
  std::vector<Row> standing = {};
};

/// A coast-down file has one row per run, or the curves of its runs.
using CoastdownSet = std::variant<TrialSet<StopTimeRow>, std::vector<CoastCurve>>;

}  // namespace awmr
