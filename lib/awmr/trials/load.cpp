#include "awmr/trials/load.h"

#include <string>
#include <utility>

#include "awmr/trials/log_consistency.h"
#include "awmr/trials/steady.h"

namespace awmr {
namespace {

/// The value read, or nothing and its faults among the others.
template <class Read>
std::optional<Read> keep(Result<Read> read, std::vector<Fault>& faults) {
  if (read) return std::move(*read);
  faults.insert(faults.end(), read.error().faults.begin(), read.error().faults.end());
  return std::nullopt;
}

/// Curves of several files add up; stop times come in one file.
void add_coastdown(const std::filesystem::path& path, CoastdownSet set, TrialData& data,
                   std::vector<Fault>& faults) {
  if (const auto* curves = std::get_if<std::vector<CoastCurve>>(&set)) {
    data.curves.insert(data.curves.end(), curves->begin(), curves->end());
  } else if (data.coastdown) {
    faults.push_back({path.string(), "a second file of stop times; put all rows into one"});
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
    all->rows.insert(all->rows.end(), found.rows.begin(), found.rows.end());
  }
}

/// Rows found in logs join those of a file; their findings name the log.
void add_steady_runs(Trials& trials) {
  for (const DrivingLog& log : trials.data.logs) {
    SteadyRuns runs = steady_runs(log, trials.vehicle, {}, trials.findings);
    join(trials.data.surge, std::move(runs.surge));
    join(trials.data.turning, std::move(runs.turning));
  }
}

Status check(const TrialFiles& files) {
  if (!files.surge && !files.turning && files.coastdowns.empty() && files.logs.empty()) {
    return input_error("", "no trials: give at least one surge, turning, coast-down or log file");
  }
  if (files.steady_from_logs && files.logs.empty()) {
    return input_error("", "steady stretches of logs were asked for, but there is no log");
  }
  return {};
}

}  // namespace

Result<Trials> load_trials(const TrialFiles& files) {
  AWMR_RETURN_IF_ERROR(check(files));
  Trials trials{.vehicle = files.vehicle, .data = {}, .findings = {}};
  auto& [vehicle, data, findings] = trials;
  std::vector<Fault> faults;
  if (files.surge) data.surge = keep(read_surge(*files.surge, files.options, findings), faults);
  if (files.turning) {
    data.turning = keep(read_turning(*files.turning, vehicle, files.options, findings), faults);
  }
  for (const std::filesystem::path& path : files.coastdowns) {
    auto set = keep(read_coastdown(path, files.options, findings), faults);
    if (set) add_coastdown(path, std::move(*set), data, faults);
  }
  for (const std::filesystem::path& path : files.logs) {
    auto log = keep(read_log(path, files.options, findings), faults);
    if (!log) continue;
    if (const auto sound = check_consistency(*log, path.string(), vehicle, files.options, findings);
        !sound) {
      faults.insert(faults.end(), sound.error().faults.begin(), sound.error().faults.end());
    }
    data.logs.push_back(std::move(*log));
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  if (files.steady_from_logs) add_steady_runs(trials);
  return trials;
}

}  // namespace awmr
