/// Reads and combines all trial files of one vehicle: the input of identify().
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

/// Trial files to read.
struct TrialFiles {
  Vehicle vehicle;
  /// Runs at constant thrust with straight wheels: identify a1, b1.
  std::optional<std::filesystem::path> surge = {};
  /// Runs at constant thrust and steering: identify a3, b3.
  std::optional<std::filesystem::path> turning = {};
  /// Motors off: identify m', I'z. Any number of files with curves, one with stop times.
  std::vector<std::filesystem::path> coastdowns = {};
  /// Driving logs: commands and measurements by time.
  std::vector<std::filesystem::path> logs = {};
  /// Adds steady stretches of the logs to the surge and turning rows. For use when there is a log
  /// but no table runs.
  bool steady_from_logs = false;
  /// Column names, and which of two values of one quantity to use; for every file.
  TrialOptions options = {};
};

/// Reads and combines the files. Errors (input): no file; as read_surge(), read_turning(),
/// read_coastdown() and read_log(), with the faults of all files; tables and logs that contradict
/// themselves or the vehicle (table_consistency.h, log_consistency.h); a second file of stop times;
/// steady stretches requested without a log; an unknown or unused mapping.
Result<Trials> load_trials(const TrialFiles& files);

}  // namespace awmr
