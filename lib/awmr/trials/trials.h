/// Trial CSVs -> typed trials in SI units, with what is doubtful about them. See the contract's
/// columns in the README.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// A run at constant tau_speed with d_r = 0.                                     [paper (45)-(54)]
struct SurgeRow {
  int line = 0;
  double tau_speed = 0.0;            ///< 4 F', > 0
  double speed_mps = 0.0;            ///< steady speed as used, > 0
  std::optional<double> distance_m;  ///< with elapsed_s where the run was timed
  std::optional<double> elapsed_s;
};

/// A run at constant F' and d_r, to the steady yaw rate. Magnitudes: g3 is odd, so a turn to the
/// right is taken as its mirror image.                                                    [paper
/// (61)-(63)]
struct TurningRow {
  int line = 0;
  double steering_rad = 0.0;
  double wheel_force = 0.0;     ///< F' of each wheel
  double tau_turn_m = 0.0;      ///< as used: printed where given, else 2 l_f F' sin d_r
  double yaw_rate_radps = 0.0;  ///< as used
  std::optional<double> turns;
  std::optional<double> elapsed_s;
};

/// Motors off at `initial_speed_mps`, at rest after `stop_time_s`.               [paper (55)-(60)]
struct StopTimeRow {
  int line = 0;
  double initial_speed_mps = 0.0;
  double stop_time_s = 0.0;
  double timing_std_s = 0.0;  ///< how well the time is known from the way it is written
};

/// One coast-down as it was recorded: speed by time, motors off at some unknown moment.
struct CoastCurve {
  std::string file;
  int line = 0;  ///< of its first row
  std::vector<double> t_s;
  std::vector<double> speed_mps;
};

/// A file of one kind. Rows that carry no information for a power law (at rest, no force) are set
/// aside.
template <class Row>
struct TrialSet {
  std::string file;
  std::vector<Row> rows;
  int set_aside = 0;
};

/// A coast-down file is either of the two.
struct CoastdownSet : TrialSet<StopTimeRow> {
  std::vector<CoastCurve> curves;
};

/// Which value is used where a row gives a speed or yaw rate both as printed and through its
/// timing.
enum class Preference { kPrinted, kTimed };

struct TrialOptions {
  std::vector<ColumnMapping> columns;
  Preference preference = Preference::kPrinted;
};

/// Readers. Findings added: `speed-mismatch`, `yaw-rate-mismatch`, `tau-turn-mismatch`,
/// `steering-stop`, `rows-set-aside`. Errors: as read_csv; missing column combinations; negative
/// speed, time or distance; a curve whose time does not rise or that is too short.
Result<TrialSet<SurgeRow>> read_surge(const std::filesystem::path& path,
                                      const TrialOptions& options, std::vector<Finding>& findings);
Result<TrialSet<TurningRow>> read_turning(const std::filesystem::path& path, const Vehicle& vehicle,
                                          const TrialOptions& options,
                                          std::vector<Finding>& findings);
Result<CoastdownSet> read_coastdown(const std::filesystem::path& path, const TrialOptions& options,
                                    std::vector<Finding>& findings);

}  // namespace awmr
