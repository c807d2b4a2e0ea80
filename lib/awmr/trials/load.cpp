#include "awmr/trials/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/trials/checks/dead_reckoning.h"
#include "awmr/trials/checks/log_consistency.h"
#include "awmr/trials/checks/repeated_logs.h"
#include "awmr/trials/checks/table_consistency.h"
#include "awmr/trials/steady.h"
#include "awmr/trials/trial_columns.h"

namespace awmr {
namespace {

/// Returns the value of the result `read`. If reading failed, adds the errors of `read` to `faults`
/// and returns empty.
template <class Read>
std::optional<Read> keep(Result<Read> read, std::vector<Fault>& faults) {
  if (read) return std::move(*read);
  append(faults, read.error().faults);
  return std::nullopt;
}

/// Adds the content of one coast-down file. Several files may have curves, but only one file may
/// have stop times.
void add_coastdown(const std::filesystem::path& path, CoastdownSet set, TrialData& data,
                   std::vector<Fault>& faults) {
  if (const auto* curves = std::get_if<std::vector<CoastCurve>>(&set)) {
    append(data.curves, *curves);
  } else if (data.coastdown) {
    faults.push_back({ErrorCode::kGivenTwice, path.string(),
                      "a second file of stop times; put all stop times into one file"});
  } else {
    data.coastdown = std::get<TrialSet<StopTimeRow>>(std::move(set));
  }
}

template <class Row>
void join(std::optional<TrialSet<Row>>& all, TrialSet<Row> found) {
  if (found.rows.empty()) return;
  if (!all) {
    all = std::move(found);
  } else {
    append(all->rows, found.rows);
  }
}

void add_steady_runs(Trials& trials) {
  for (const DrivingLog& log : trials.data.logs) {
    SteadyRuns runs = steady_runs(log, trials.vehicle, trials.findings);
    join(trials.data.surge, std::move(runs.surge));
    join(trials.data.turning, std::move(runs.turning));
  }
}

/// Checks the logs of one file by check_consistency(), and adds them to the trials. Logs with
/// faults are added like all others, so that later checks can report further faults.
void add_logs(const std::filesystem::path& path, std::vector<DrivingLog> logs,
              const TrialOptions& options, Trials& trials, std::vector<Fault>& faults) {
  const int number = trials.data.logs.empty() ? 1 : trials.data.logs.back().number + 1;
  for (DrivingLog& log : logs) {
    log.number = number;
    const std::string place =
        logs.size() == 1 ? path.string() : path.string() + ":" + std::to_string(log.line.front());
    if (const auto sound = check_consistency(log, place, trials.vehicle, options, trials.findings);
        !sound) {
      append(faults, sound.error().faults);
    }
    set_aside_dead_reckoning(log, trials.findings);
    trials.data.logs.push_back(std::move(log));
  }
}

std::vector<std::size_t> mappings_used(const TrialData& data) {
  std::vector<std::size_t> used;
  if (data.surge) append(used, data.surge->mapped);
  if (data.turning) append(used, data.turning->mapped);
  if (data.coastdown) append(used, data.coastdown->mapped);
  for (const CoastCurve& curve : data.curves) append(used, curve.mapped);
  for (const DrivingLog& log : data.logs) append(used, log.mapped);
  return used;
}

/// Returns the paths in the order in which load_trials() reads and reports the files.
std::vector<std::filesystem::path> paths_as_read(const TrialFiles& files) {
  std::vector<std::filesystem::path> paths;
  if (files.surge) paths.push_back(*files.surge);
  if (files.turning) paths.push_back(*files.turning);
  append(paths, files.coastdowns);
  append(paths, files.logs);
  return paths;
}

/// Checks that a table with a row per run is a file. A directory is a recording of several topics,
/// which can be a log or a coast-down curve, but no such table.
Status check_no_directory(const std::optional<std::filesystem::path>& path) {
  std::error_code error;
  if (!path || !std::filesystem::is_directory(*path, error)) return {};
  return input_error(ErrorCode::kWrongFile, path->string(), "this is a directory; give a file");
}

/// Reads the surge, turning and coast-down files, and compares each with the vehicle and the other
/// tables.
void read_tables(const TrialFiles& files, const TrialOptions& options, Trials& trials,
                 std::vector<Fault>& faults) {
  auto& [vehicle, data, findings] = trials;
  std::vector<Finding> of_turning;
  if (files.surge) data.surge = keep(read_surge(*files.surge, options, findings), faults);
  if (files.turning) {
    data.turning = keep(read_turning(*files.turning, vehicle, options, of_turning), faults);
  }
  const Tables tables{vehicle, data.surge, data.turning};
  if (data.surge) {
    check_consistency(*data.surge, *files.surge, tables, options, findings, faults);
  }
  append(findings, of_turning);
  if (data.turning) {
    check_consistency(*data.turning, *files.turning, tables, options, findings, faults);
  }
  for (const std::filesystem::path& path : files.coastdowns) {
    auto set = keep(read_coastdown(path, options, findings), faults);
    if (!set) continue;
    check_consistency(*set, path, tables, options, findings, faults);
    add_coastdown(path, std::move(*set), data, faults);
  }
  warn_of_slow_coasts(data, findings);
}

/// Sorts the paths by file name, so that results do not depend on the order of the options.
std::vector<std::filesystem::path> in_order_of_names(std::vector<std::filesystem::path> paths) {
  std::sort(paths.begin(), paths.end(), [](const auto& a, const auto& b) {
    return std::pair(a.filename(), a) < std::pair(b.filename(), b);
  });
  return paths;
}

Status check(const TrialFiles& files) {
  if (!files.surge && !files.turning && files.coastdowns.empty() && files.logs.empty()) {
    return input_error(ErrorCode::kMissing, "",
                       "no trials: give at least one surge, turning, coast-down or log file");
  }
  if (files.steady_from_logs && files.logs.empty()) {
    return input_error(ErrorCode::kMissing, "",
                       "steady parts of logs were requested, but no log was given; add a log");
  }
  return {};
}

}  // namespace

std::vector<std::filesystem::path> paths_of(const TrialFiles& files) {
  std::vector<std::filesystem::path> paths;
  if (files.surge) paths.push_back(*files.surge);
  append(paths, files.coastdowns);
  if (files.turning) paths.push_back(*files.turning);
  append(paths, files.logs);
  return paths;
}

Result<Trials> load_trials(Vehicle vehicle, const TrialFiles& files) {
  AWMR_RETURN_IF_ERROR(check(files));
  AWMR_RETURN_IF_ERROR(check_no_directory(files.surge));
  AWMR_RETURN_IF_ERROR(check_no_directory(files.turning));
  AWMR_ASSIGN_OR_RETURN(const TrialOptions options, with_vehicle_columns(files.options, vehicle));
  Trials trials{.vehicle = std::move(vehicle), .data = {}, .findings = {}};
  TrialData& data = trials.data;
  std::vector<Finding>& findings = trials.findings;
  std::vector<Fault> faults;
  read_tables(files, options, trials, faults);
  for (const std::filesystem::path& path : in_order_of_names(files.logs)) {
    auto logs = keep(read_logs(path, options, findings), faults);
    if (logs) add_logs(path, std::move(*logs), options, trials, faults);
  }
  check_repeated_logs(data.logs, faults);
  check_repeated_curves(data.curves, faults);
  const std::vector<std::filesystem::path> paths = paths_as_read(files);
  if (!faults.empty()) {
    append(faults, unusable_mappings(options, paths));
    return input_errors(std::move(faults));
  }
  AWMR_RETURN_IF_ERROR(check_mappings(options, mappings_used(data), paths));
  if (files.steady_from_logs) add_steady_runs(trials);
  return trials;
}

}  // namespace awmr
