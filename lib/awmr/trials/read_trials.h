/// Reads trial CSVs as typed trials in SI units, with findings. The README lists the columns.
#pragma once

#include <filesystem>
#include <limits>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Value to use if a row contains a speed or yaw rate both printed and timed.
enum class Preference { kPrinted, kTimed };
inline constexpr NameTable<Preference, 2> kPreferenceNames{
    {{"printed", Preference::kPrinted}, {"timed", Preference::kTimed}}};

struct TrialOptions {
  std::vector<ColumnMapping> columns;
  Preference preference = Preference::kPrinted;
  /// Accept trials that contradict themselves or the vehicle (log_consistency.h,
  /// table_consistency.h), with a warning. For unusual vehicles.
  bool as_is = false;
  /// False: the vehicle has no steering, and a log without a steering column has straight wheels.
  bool has_steering = true;
  /// Number of driven wheels n: tau_speed = n F' of a surge row.
  int driven_wheels = 4;
  /// Times that are used of each log, s, as in its t_s.
  Interval used_s{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
  /// Times that are not. The log before and after them is read as two runs.
  std::vector<Interval> excluded_s = {};
};

/// Findings: `speed-mismatch`, `yaw-rate-mismatch`, `tau-turn-mismatch`, `steering-stop`,
/// `rows-set-aside`. Errors: as read_csv; missing column combinations; negative speed, time or
/// distance; a curve whose time does not rise or that is too short.
Result<TrialSet<SurgeRow>> read_surge(const std::filesystem::path& path,
                                      const TrialOptions& options, std::vector<Finding>& findings);
Result<TrialSet<TurningRow>> read_turning(const std::filesystem::path& path, const Vehicle& vehicle,
                                          const TrialOptions& options,
                                          std::vector<Finding>& findings);
Result<CoastdownSet> read_coastdown(const std::filesystem::path& path, const TrialOptions& options,
                                    std::vector<Finding>& findings);

/// Columns: t_s, force_left, force_right, steering_cmd_deg or steering_deg (for a vehicle with
/// steering), and any of the channels. latitude_deg and longitude_deg may replace x_m and y_m
/// (local tangent plane at the first row that is used). Findings: `held-samples`, `log-gap`, and those of
/// channel_quality.h. Errors: as read_csv; time that does not rise; no measurement; fewer than 10
/// rows; more than one run.
Result<DrivingLog> read_log(const std::filesystem::path& path, const TrialOptions& options,
                            std::vector<Finding>& findings);

/// Like read_log() for a file with one or several runs, separated by a column `run`: one log per
/// run.
Result<std::vector<DrivingLog>> read_logs(const std::filesystem::path& path,
                                          const TrialOptions& options,
                                          std::vector<Finding>& findings);

}  // namespace awmr
