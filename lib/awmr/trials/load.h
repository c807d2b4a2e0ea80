/// Reads and combines all trial files of one vehicle: the input of identify().
///
///     const auto trials = load_trials(*robot, {.surge = "surge.csv"});
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/read_trials.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// Trial files of one vehicle.
struct TrialFiles {
  /// Table of runs at constant thrust with straight wheels, from which the surge resistance (a1, b1
  /// of a power law) is identified.
  std::optional<std::filesystem::path> surge = {};
  /// Table of runs at constant thrust and steering, from which the yaw resistance (a3, b3) is
  /// identified.
  std::optional<std::filesystem::path> turning = {};
  /// Coast-downs (motors off), from which m' = m/F_max and I'z = Iz/F_max are identified: any
  /// number of files with curves, at most one with stop times.
  std::vector<std::filesystem::path> coastdowns = {};
  /// Driving logs: commands and measurements by time.
  std::vector<std::filesystem::path> logs = {};
  /// True: also uses parts of the logs with steady motion (steady.h) as rows of the surge or
  /// turning table. For vehicles with a log but without these tables.
  bool steady_from_logs = false;
  /// Options for reading every file, such as column mappings.
  TrialOptions options = {};
};

/// Returns the paths of the files in the order in which model.json lists them: surge, coast-downs,
/// turning, logs.
std::vector<std::filesystem::path> paths_of(const TrialFiles& files);

/// Reads and combines the files. `vehicle`: the vehicle that made the trials. Adds the findings of
/// all checks, and leaves out poses of an odometry (dead_reckoning.h). Reports the errors of all
/// files at once. Errors (input): no file; the errors of read_surge(), read_turning(),
/// read_coastdown() and read_logs(); tables and logs that contradict themselves or the vehicle
/// (table_consistency.h, log_consistency.h); the same log given twice; a second file of stop times;
/// steady_from_logs without a log; an unknown or unused column mapping.
Result<Trials> load_trials(Vehicle vehicle, const TrialFiles& files);

}  // namespace awmr
