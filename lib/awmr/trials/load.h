/// All the trial files of one vehicle, read and joined: the way in to identify().
///
///     const auto trials = load_trials({.vehicle = *robot, .surge = "surge.csv"});
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/read_trials.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// Which files to read; those of the vehicle's trials that there are.
struct TrialFiles {
  Vehicle vehicle;
  /// Runs at constant thrust, wheels straight: show a1, b1.
  std::optional<std::filesystem::path> surge = {};
  /// Runs at constant thrust and steering: show a3, b3.
  std::optional<std::filesystem::path> turning = {};
  /// Motors off: show m', I'z. Any number of files of whole curves, one of stop times.
  std::vector<std::filesystem::path> coastdowns = {};
  /// Driving logs: commands and whatever was measured, by time.
  std::vector<std::filesystem::path> logs = {};
  /// Steady stretches of the logs join the surge and turning rows. For when there is a log, but
  /// nobody drove the runs of the tables.
  bool steady_from_logs = false;
  /// Names of the columns, and which of two values of one quantity counts; of every file.
  TrialOptions options = {};
};

/// Reads and joins them. Errors (input): no file at all; as read_surge(), read_turning(),
/// read_coastdown() and read_log(), the faults of all files together; tables and logs that contradict
/// themselves or the vehicle (table_consistency.h, log_consistency.h); a second file of stop times;
/// steady stretches asked for without a log; a mapping that is unknown or unused.
Result<Trials> load_trials(const TrialFiles& files);

}  // namespace awmr
