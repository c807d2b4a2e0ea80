/// Rows of surge, turning and coast-down trials in SI units, one per run, and recorded coast-down
/// curves. read_trials.h reads them.
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

/// A run at constant thrust tau_speed and steering angle d_r = 0, to the steady speed u at which
/// the thrust equals the surge resistance g1:
///   tau_speed = g1(u)                                                            [paper (45)-(46)]
struct SurgeRow {
  int line = 0;                      ///< line in the file
  double tau_speed = 0.0;            ///< n F' of n driven wheels, dimensionless, > 0
  double speed_mps = 0.0;            ///< u, m/s, > 0: as printed in the file or timed
  std::optional<double> distance_m;  ///< m, > 0; given together with elapsed_s if the run was timed
  std::optional<double> elapsed_s;   ///< s, > 0
};

/// A run with the same force F' on every wheel and a constant steering angle d_r, to the steady yaw
/// rate r at which the yaw moment tau_turn equals the yaw resistance g3:
///   tau_turn = 2 l_f F' sin d_r = g3(r)                                          [paper (61)-(62)]
/// A differential turn has d_r = 0; without steering, every turn is differential:
///   tau_turn = 2 d (F'R - F'L) = g3(r)                                                [paper (41)]
/// All values are magnitudes: a turn to the right is stored as its mirror image, because g3 is odd.
struct TurningRow {
  int line = 0;                     ///< line in the file
  double steering_rad = 0.0;        ///< d_r, rad, > 0; 0 for differential turns
  double wheel_force = 0.0;         ///< F' of each wheel, over F_max, > 0; 0 for differential turns
  double tau_turn_m = 0.0;          ///< yaw moment/F_max, m, > 0: from the file, else computed
  double yaw_rate_radps = 0.0;      ///< r, rad/s, > 0: as printed in the file or timed
  std::optional<double> turns;      ///< number of full turns, > 0; given with elapsed_s if timed
  std::optional<double> elapsed_s;  ///< s, > 0
  /// Set for differential turns: F' of each left and of each right wheel. The larger is `right`.
  std::optional<SideForces<double>> sides = {};
  /// True: the file has a negative steering angle, or a larger force on the left side. The other
  /// numbers of such a row are those of the mirror-image turn to the left.
  bool is_right_turn = false;
};

/// A coast-down timed with a stop watch: the motors are switched off at the speed u_max, and the
/// vehicle rests after the time t_a. stop_time_s() in model/steady.h has the equation.
struct StopTimeRow {
  int line = 0;                    ///< line in the file
  double initial_speed_mps = 0.0;  ///< u_max, m/s, > 0
  double stop_time_s = 0.0;        ///< t_a, s, > 0
  /// Standard deviation of stop_time_s, s, > 0, from the decimal places of the times in the file.
  double timing_std_s = 0.0;
};

/// A recorded coast-down: speed over time. The motors are switched off at an unknown time.
struct CoastCurve {
  std::string file;
  int line = 0;  ///< line of its first row
  std::vector<double> t_s;
  std::vector<double> speed_mps;
  /// Column mappings that were used: indices in TrialOptions::columns.
  std::vector<std::size_t> mapped = {};
  bool of_bins = false;  ///< true: built from columns from_mps, to_mps, elapsed_s (speed bins)
};

/// Rows of one file. A row without motion or force is not used, only counted, because it has no
/// logarithm for the fit of a power law.                                    [paper (49), corrected]
/// Corrected: (49) prints twelve rows for eleven trials, the first of them the logarithm of zero.
template <class Row>
struct TrialSet {
  std::string file;
  std::vector<Row> rows;
  int set_aside = 0;  ///< number of rows that are not used
  /// Column mappings that were used: indices in TrialOptions::columns.
  std::vector<std::size_t> mapped = {};
  /// Source column of the forces: "tau_speed" or "wheel_force".
  std::string force_column = {};
  /// Source column of the rate of a turning run: "yaw_rate_radps" or "turns".
  std::string rate_column = {};
  /// Differential turns of a vehicle with steering. They are not in `rows`, because their
  /// resistance includes tyre scrub, which g3 of steered turns does not. Empty if the table has no
  /// steered turn; the differential turns are then in `rows`.
  std::vector<Row> by_sides = {};
  /// Runs with a force difference in which the vehicle did not turn. The yaw moment of such a run
  /// is a lower bound of the moment at which the tyres begin to slide.
  std::vector<Row> standing = {};
};

/// Content of a coast-down file: timed coast-downs (one row per run), or recorded curves.
using CoastdownSet = std::variant<TrialSet<StopTimeRow>, std::vector<CoastCurve>>;

}  // namespace awmr
