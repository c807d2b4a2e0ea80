#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <set>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/identify/identify.h"
#include "awmr/model/model_file.h"
#include "awmr/model/plausibility.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/trials/column_guess.h"
#include "awmr/tune/tune_file.h"
#include "commands.h"
#include "option_values.h"
#include "project.h"
#include "project_options.h"

namespace awmr::cli {
namespace {

struct CheckCommand {
  fs::path project;
};

/// Problems found in a project, in the order in which the user should solve them.
struct Check {
  std::vector<Finding> missing;      ///< values and trials not provided yet
  std::vector<Finding> implausible;  ///< contradictory or impossible values
  std::vector<Finding> notes;        ///< findings of the trial readers
  std::vector<Fault> faults;         ///< unreadable files
};

void take(const Error& error, std::vector<Fault>& faults) { append(faults, error.faults); }

/// True if the value at `place` (a fault's place, `FILE:/json/pointer`) is null.
bool is_null_at(const Json& document, const std::string& file, const std::string& place) {
  if (!place.starts_with(file + ":/")) return false;
  const Json::json_pointer pointer(place.substr(file.size() + 1));
  return document.contains(pointer) && document.at(pointer).is_null();
}

/// Reads a JSON file of the project. Reports a null value as missing, not as an error of the file:
/// it marks what the user still has to fill in.
template <class T>
std::optional<T> read_filled(const fs::path& path, Result<T> (*read)(const fs::path&),
                             Check& check) {
  Result<T> result = read(path);
  if (result) return std::move(*result);
  const auto document = read_json_file(path);
  for (const Fault& fault : result.error().faults) {
    if (document && is_null_at(*document, path.string(), fault.place)) {
      check.missing.push_back({fault.place, 0, Severity::kError, "missing-value",
                               "to be filled in: the value is null. Measure it as the project's "
                               "README describes"});
    } else {
      check.faults.push_back(fault);
    }
  }
  return std::nullopt;
}

/// Returns a vehicle with only the drive of the file, if it has a valid one. Messages need the
/// drive to describe the trials, before the other values of the vehicle are filled in.
Vehicle vehicle_with_drive(const fs::path& path) {
  Vehicle vehicle;
  const auto document = read_json_file(path);
  if (!document || !document->is_object()) return vehicle;
  const auto drive = document->find("drive");
  if (drive == document->end() || !drive->is_string()) return vehicle;
  vehicle.drive = value_in(kDriveNames, drive->get<std::string>()).value_or(vehicle.drive);
  return vehicle;
}

/// True if the table or log has at least one row. Adds a fault if the file cannot be read.
bool has_rows(const fs::path& path, Check& check) {
  const auto sample = sample_of(path);
  if (!sample) {
    take(sample.error(), check.faults);
    return false;
  }
  const auto is_filled = [](const auto& column) { return !column.empty(); };
  return std::any_of(sample->values.begin(), sample->values.end(), is_filled) ||
         std::any_of(sample->texts.begin(), sample->texts.end(), is_filled);
}

/// Returns one of the parameters that this kind of trial identifies. trial_of() uses it to find the
/// description of the trial for messages.
ParameterId shown_by(TrialKind kind) {
  switch (kind) {
    case TrialKind::kTurning:
      return ParameterId::kYawAlpha;
    case TrialKind::kCoastdown:
      return ParameterId::kMassNorm;
    default:
      return ParameterId::kSurgeAlpha;
  }
}

/// Returns the trial files that have at least one row. Reports the files without rows as missing.
TrialFiles recorded(const Project& project, const Vehicle& vehicle, Check& check) {
  TrialFiles files = project.trials;
  const auto is_recorded = [&](const fs::path& path, TrialKind kind) {
    const std::size_t faults = check.faults.size();
    if (has_rows(path, check)) return true;
    if (check.faults.size() > faults) return false;
    check.missing.push_back(
        {path.string(), 0, Severity::kError, "missing-trial",
         fmt::format("no runs yet: record {}", kind == TrialKind::kLog
                                                   ? "a driving log"
                                                   : trial_of(vehicle, shown_by(kind)))});
    return false;
  };
  if (files.surge && !is_recorded(*files.surge, TrialKind::kSurge)) files.surge.reset();
  if (files.turning && !is_recorded(*files.turning, TrialKind::kTurning)) files.turning.reset();
  std::erase_if(files.coastdowns,
                [&](const fs::path& path) { return !is_recorded(path, TrialKind::kCoastdown); });
  std::erase_if(files.logs,
                [&](const fs::path& path) { return !is_recorded(path, TrialKind::kLog); });
  return files;
}

/// Adds the error `missing-trial` for each parameter that no trial of the project identifies. (A
/// driving log identifies all parameters.) Adds the note `assumed-sway` if nothing gives the sway
/// resistance. `is_complete`: false if the file gives only the drive of `vehicle`.
void check_what_nothing_shows(const Project& project, const Vehicle& vehicle, bool is_complete,
                              Check& check) {
  const TrialFiles& trials = project.trials;
  if (!trials.logs.empty()) return;
  const auto nothing_shows = [&](ParameterId id) {
    check.missing.push_back(
        {"", 0, Severity::kError, "missing-trial",
         fmt::format("no trial determines {} ({}), which awmr tune needs; record {}", info(id).name,
                     info(id).meaning, trial_of(vehicle, id))});
  };
  if (!trials.surge) nothing_shows(ParameterId::kSurgeAlpha);
  if (!trials.turning) nothing_shows(ParameterId::kYawAlpha);
  if (trials.coastdowns.empty()) nothing_shows(ParameterId::kMassNorm);
  if (!is_complete || vehicle.sway_alpha) return;
  check.notes.push_back(
      {project.vehicle.string() + ":/sway_alpha", 0, Severity::kNote, "assumed-sway",
       fmt::format(
           "sway_alpha ({}) is not given: identify assumes the value of common tyres, which can "
           "be wrong by a factor of {:.1f}. If sideslip matters, give a driving log with "
           "sway_mps, or set sway_alpha in vehicle.json",
           info(ParameterId::kSwayAlpha).meaning, assumed_sway_factor())});
}

/// If the list has a fault of the file `path`, adds a fault that suggests column mappings, guessed
/// from the file's column names. `track_m`: as in guess_columns().
void add_mapping_hint(const fs::path& path, TrialKind kind, const TrialOptions& options,
                      double track_m, std::vector<Fault>& faults) {
  const std::string place = path.string() + ":";
  if (std::none_of(faults.begin(), faults.end(),
                   [&](const Fault& fault) { return fault.place.starts_with(place); })) {
    return;
  }
  const auto sample = sample_of(path);
  if (!sample) return;
  std::set<std::string> known(sample->names.begin(), sample->names.end());
  for (const ColumnMapping& mapping : options.columns) known.insert(mapping.name);
  std::vector<std::string> pairs;
  for (const ColumnGuess& guess : guess_columns(*sample, kind, track_m)) {
    if (guess.expression.empty() || !known.insert(guess.column).second) continue;
    pairs.push_back(fmt::format("\"{}\": \"{}\"", guess.column, guess.expression));
  }
  if (pairs.empty()) return;
  faults.push_back({ErrorCode::kMissing, path.string() + ":1:1",
                    fmt::format("suggested entry for project.json's trials, from the column names: "
                                "\"columns\": {{\"{}\": {{{}}}}}; awmr map {} --trial {} gives the "
                                "reasons",
                                path.filename().string(), fmt::join(pairs, ", "), path.string(),
                                name_in(kTrialKindNames, kind))});
}

void add_mapping_hints(const Vehicle& vehicle, const TrialFiles& files,
                       std::vector<Fault>& faults) {
  const auto add = [&](const fs::path& path, TrialKind kind) {
    add_mapping_hint(path, kind, files.options, 2.0 * vehicle.half_track_m, faults);
  };
  if (files.surge) add(*files.surge, TrialKind::kSurge);
  if (files.turning) add(*files.turning, TrialKind::kTurning);
  for (const fs::path& path : files.coastdowns) add(path, TrialKind::kCoastdown);
  for (const fs::path& path : files.logs) add(path, TrialKind::kLog);
}

/// Checks the trials for consistency with each other and with the vehicle.
void check_trials(const Vehicle& vehicle, TrialFiles files, bool all_recorded, Check& check) {
  if (paths_of(files).empty()) return;
  // A column mapping that no file uses is usually an error. But it is accepted as long as some
  // files have no rows: it may be for one of these, which are not read.
  for (ColumnMapping& mapping : files.options.columns) mapping.standing |= !all_recorded;
  files.steady_from_logs = files.steady_from_logs && !files.logs.empty();
  const bool as_is = files.options.as_is;
  files.options.as_is = true;
  const auto trials = load_trials(vehicle, files);
  if (!trials) {
    take(trials.error(), check.faults);
    return add_mapping_hints(vehicle, files, check.faults);
  }
  const auto contradicts = [](const Finding& finding) {
    return finding.code == "table-contradiction" || finding.code == "log-contradiction";
  };
  const std::vector<Finding>& found = trials->findings;
  append(check.notes, found);
  if (as_is || std::none_of(found.begin(), found.end(), contradicts)) return;
  // If `as_is` is false, each contradiction is a fault, and its message has the column mapping that
  // corrects it.
  std::erase_if(check.notes, contradicts);
  files.options.as_is = false;
  if (const auto refused = load_trials(vehicle, files); !refused) {
    for (const Fault& fault : refused.error().faults) {
      check.implausible.push_back(
          {fault.place, 0, Severity::kError, "contradiction", fault.message});
    }
  }
}

Result<Check> check_project(const Project& project) {
  Check check;
  const auto vehicle = read_filled<Vehicle>(project.vehicle, read_vehicle, check);
  const Vehicle described = vehicle ? *vehicle : vehicle_with_drive(project.vehicle);
  const TrialFiles files = recorded(project, described, check);
  for (const fs::path& path : project.scenarios) {
    read_filled<Scenario>(path, read_scenario, check);
  }
  if (project.tune) read_filled<TuneConfig>(*project.tune, read_tune_config, check);
  check_what_nothing_shows(project, described, vehicle.has_value(), check);
  if (vehicle && check.faults.empty()) {
    check.implausible = plausibility_findings(*vehicle, Severity::kError, project.vehicle.string());
    const bool all_recorded = paths_of(files) == paths_of(project.trials);
    check_trials(*vehicle, files, all_recorded, check);
  }
  if (!check.faults.empty()) return input_errors(std::move(check.faults));
  return check;
}

std::ptrdiff_t count(const Check& check, std::string_view code) {
  return std::count_if(check.missing.begin(), check.missing.end(),
                       [&](const Finding& finding) { return finding.code == code; });
}

std::string document_of(const Check& check) {
  Json json;
  json["to_fill_in"] = count(check, "missing-value");
  json["to_record"] = count(check, "missing-trial");
  json["implausible"] = check.implausible.size();
  return awmr::to_text(json);
}

std::string summary_of(const fs::path& project, const Check& check) {
  if (check.missing.empty() && check.implausible.empty()) {
    return fmt::format("{}: no problems found; next: awmr run {} -o out\n", project.string(),
                       project.string());
  }
  return fmt::format("{}: {} to fill in, {} to record, {} implausible\n", project.string(),
                     count(check, "missing-value"), count(check, "missing-trial"),
                     check.implausible.size());
}

Result<Outcome> execute(const CheckCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const bool is_folder, directory_exists(command.project));
  const fs::path path = is_folder ? command.project / "project.json" : command.project;
  if (is_folder) AWMR_RETURN_IF_ERROR(check_regular_file(path));
  AWMR_ASSIGN_OR_RETURN(const Project project, read_project(path));
  const Result<Check> check = check_project(project);
  if (!check) return for_project("identify", tl::unexpected(check.error()));
  Outcome outcome{.summary = summary_of(path, *check), .document = document_of(*check)};
  for (const auto* findings : {&check->missing, &check->implausible, &check->notes}) {
    outcome.findings.insert(outcome.findings.end(), findings->begin(), findings->end());
  }
  outcome.refused = !check->missing.empty() || !check->implausible.empty();
  return for_project("identify", std::move(outcome));
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  auto command = std::make_shared<CheckCommand>();
  CLI::App* sub = add_command(
      app, session, "check", "Check a project for missing and implausible values before any fit",
      "awmr check configs/paper/project.json\n"
      "Exit codes: 0 no problems; 1 something is missing or implausible; 2 bad input",
      [command] { return execute(*command); });
  add_file(*sub, "PROJECT", command->project, "project.json, or its directory")->required();
}

}  // namespace awmr::cli
