/// Reads the files of surge, turning and coast-down trials and of driving logs, as typed rows in SI
/// units. apps/awmr/COMMANDS.md lists the columns.
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

/// Value to use if a row gives a speed or yaw rate in two ways. The printed value is the number in
/// its column. The timed value is the distance or number of turns divided by the elapsed time.
enum class Preference { kPrinted, kTimed };
inline constexpr NameTable<Preference, 2> kPreferenceNames{
    {{"printed", Preference::kPrinted}, {"timed", Preference::kTimed}}};

struct TrialOptions {
  /// Column mappings; load_trials() appends those of the vehicle file.
  std::vector<ColumnMapping> columns;
  Preference preference = Preference::kPrinted;
  /// True: accepts trials that contradict themselves or the vehicle file (log_consistency.h,
  /// table_consistency.h), with a warning. For vehicles outside the plausible ranges of these
  /// checks.
  bool as_is = false;
  /// False: the vehicle has no steering, so a log needs no steering column.
  bool has_steering = true;
  /// Number of driven wheels n: tau_speed = n F' of a surge row.
  int driven_wheels = 4;
  /// Interval of t_s, s, of each log to use, bounds included.
  Interval used_s{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
  /// Intervals of t_s, s, of each log to leave out. The rows before and the rows after such an
  /// interval become separate runs.
  std::vector<Interval> excluded_s = {};
};

/// Each function reads one table. Findings: the notes of CsvTable::notes, `speed-mismatch`,
/// `tau-speed-mismatch`, `yaw-rate-mismatch`, `tau-turn-mismatch`, `steering-stop`,
/// `turned-by-sides`, `rows-set-aside`, `repeated-rows`. Errors: those of read_csv(); missing
/// columns, or columns that exclude each other; a negative force, speed, time or distance
/// (force_left and force_right may be negative); turns whose signs, forces or angles contradict
/// each other; a coast-down curve with fewer than three rows or with times that do not rise.
Result<TrialSet<SurgeRow>> read_surge(const std::filesystem::path& path,
                                      const TrialOptions& options, std::vector<Finding>& findings);
Result<TrialSet<TurningRow>> read_turning(const std::filesystem::path& path, const Vehicle& vehicle,
                                          const TrialOptions& options,
                                          std::vector<Finding>& findings);
Result<CoastdownSet> read_coastdown(const std::filesystem::path& path, const TrialOptions& options,
                                    std::vector<Finding>& findings);

/// Reads a driving log with one run. Columns: t_s, force_left, force_right, and at least one
/// channel of log.h other than steering_deg. A vehicle with steering also needs steering_cmd_deg or
/// steering_deg. latitude_deg and longitude_deg may replace x_m and y_m. x is then east and y
/// north, in the local tangent plane at the first row used of each run. Findings: the notes of
/// CsvTable::notes, those of log_channels.h, `constant-channel`, `course-at-rest`. Errors: those
/// of read_csv(); missing or contradictory columns; a latitude or longitude out of range; times
/// that do not rise; fewer than 10 rows; no row left by used_s and excluded_s of the options; more
/// than one run.
Result<DrivingLog> read_log(const std::filesystem::path& path, const TrialOptions& options,
                            std::vector<Finding>& findings);

/// Like read_log(), but for a file with one or more runs, numbered by its column `run`. Returns one
/// log per run, or several for a run that `excluded_s` divides.
Result<std::vector<DrivingLog>> read_logs(const std::filesystem::path& path,
                                          const TrialOptions& options,
                                          std::vector<Finding>& findings);

}  // namespace awmr
