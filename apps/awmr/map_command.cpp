#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/text.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/trials/column_guess.h"
#include "awmr/trials/log_files.h"
#include "awmr/trials/trial_columns.h"
#include "commands.h"
#include "inputs.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

struct MapCommand {
  fs::path file;
  std::optional<fs::path> vehicle;
  TrialKind trial = TrialKind::kLog;
  std::optional<fs::path> output;
};

/// Alternative sets of columns for the same quantity of a trial; one complete set suffices.
using Ways = std::vector<std::vector<const char*>>;
std::vector<Ways> needs_of(TrialKind kind) {
  const Ways speed{{"speed_mps"}, {"distance_m", "elapsed_s"}};
  const Ways turn{{"yaw_rate_radps"}, {"turns", "elapsed_s"}};
  switch (kind) {
    case TrialKind::kSurge:
      return {{{"wheel_force"}, {"tau_speed"}}, speed};
    case TrialKind::kTurning:
      return {{{"steering_deg", "wheel_force"}, {"force_left", "force_right"}}, turn};
    case TrialKind::kCoastdown:
      return {{{"t_s", "speed_mps"},
               {"initial_speed_mps", "stop_time_s"},
               {"from_mps", "to_mps", "elapsed_s"}}};
    case TrialKind::kLog:
      return {
          {{"t_s"}}, {{"force_left"}}, {{"force_right"}}, {{"steering_cmd_deg"}, {"steering_deg"}}};
  }
  return {};
}

/// Returns the required columns of the trial for which the file seems to have no column. If several
/// sets of columns can give a quantity, only the missing columns of the most complete set are
/// returned.
std::vector<std::string> open_columns(const std::vector<ColumnGuess>& guesses, TrialKind kind) {
  std::set<std::string> found;
  for (const ColumnGuess& guess : guesses) found.insert(guess.column);
  std::vector<std::string> open;
  for (const Ways& ways : needs_of(kind)) {
    std::optional<std::vector<std::string>> fewest;
    for (const auto& way : ways) {
      std::vector<std::string> lacking;
      for (const char* name : way) {
        if (found.count(name) == 0) lacking.emplace_back(name);
      }
      if (!fewest || lacking.size() < fewest->size()) fewest = std::move(lacking);
    }
    open.insert(open.end(), fewest->begin(), fewest->end());
  }
  return open;
}

Json to_json(const ColumnGuess& guess) {
  Json json;
  json["column"] = guess.column;
  json["expression"] = guess.expression;
  json["confidence"] = name_in(kConfidenceNames, guess.confidence);
  json["why"] = guess.why;
  json["samples"] = Json::array();
  for (const double sample : guess.samples) {
    if (std::isfinite(sample)) json["samples"].push_back(sample);
  }
  return json;
}

std::string text_of(const MapCommand& command, const std::vector<ColumnGuess>& guesses,
                    const FileSample& sample, const Provenance& provenance) {
  Json json;
  json["schema"] = kColumnsSchema;
  put_provenance(json, provenance);
  const std::vector<ColumnGuess> used = likely_columns(guesses);
  json["columns"] = Json::object();
  for (const ColumnGuess& guess : used) {
    // No mapping is needed if the column of the file already has the required name.
    if (guess.expression != guess.column) json["columns"][guess.column] = guess.expression;
  }
  json["open"] = open_columns(used, command.trial);
  json["guesses"] = Json::array();
  for (const ColumnGuess& guess : guesses) json["guesses"].push_back(to_json(guess));
  json["names"] = sample.names;
  return awmr::to_text(json);
}

std::string summary_of(const MapCommand& command, const std::vector<ColumnGuess>& guesses,
                       const FileSample& sample) {
  std::string text = fmt::format("{}: guessed columns; please check\n", command.file.string());
  for (const ColumnGuess& guess : guesses) {
    text += fmt::format("  {:<6} {:<17} {}  ({})\n", name_in(kConfidenceNames, guess.confidence),
                        guess.column, guess.expression, guess.why);
  }
  const std::vector<std::string> open = open_columns(likely_columns(guesses), command.trial);
  for (const std::string& name : open) {
    text += fmt::format(
        "  open   {:<17} no column is a good match; to identify, give --column {}=EXPRESSION{}\n",
        name, name, name == "steering_cmd_deg" ? " (only if the vehicle steers)" : "");
  }
  if (const auto unused = unused_columns(sample, guesses); !unused.empty()) {
    text += fmt::format("  unused {}\n", shortened(fmt::format("{}", fmt::join(unused, ", "))));
  }
  if (command.output) {
    text += fmt::format("wrote {}: correct this file, then give it to identify as --columns-file\n",
                        command.output->string());
  }
  return text;
}

Result<Outcome> execute(const MapCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> files, files_of(command.file));
  if (command.output) AWMR_RETURN_IF_ERROR(check_output(*command.output, files));
  AWMR_ASSIGN_OR_RETURN(const FileSample sample, sample_of(command.file));
  std::optional<double> track_m;
  if (command.vehicle) {
    AWMR_ASSIGN_OR_RETURN(const Vehicle vehicle, read_vehicle(*command.vehicle));
    track_m = 2.0 * vehicle.half_track_m;
  }
  const std::vector<ColumnGuess> guesses = guess_columns(sample, command.trial, track_m);
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs, input_files({command.file}));
  if (command.vehicle) {
    AWMR_ASSIGN_OR_RETURN(const std::vector<InputFile> more, input_files({*command.vehicle}));
    append(inputs, more);
  }
  NamedOptions options{{"trial", std::string(name_in(kTrialKindNames, command.trial))}};
  Outcome outcome{.summary = summary_of(command, guesses, sample),
                  .document = text_of(command, guesses, sample,
                                      {"map", std::move(options), std::move(inputs)})};
  if (!command.output) return outcome;
  AWMR_RETURN_IF_ERROR(write_file(*command.output, outcome.document, check_columns_text));
  outcome.written = {*command.output};
  return outcome;
}

}  // namespace

void add_map(CLI::App& app, Session& session) {
  auto command = std::make_shared<MapCommand>();
  CLI::App* sub =
      add_command(app, session, "map", "Suggest a column mapping for a log or table, with reasons",
                  "awmr map datasets/synthetic/drive_1.csv -o map.json",
                  [command] { return execute(*command); });
  add_file(*sub, "FILE", command->file,
           "A log: CSV, ULog, DataFlash, SysId's JSON, a ROS 2 bag, or a directory of tables")
      ->required();
  add_file(*sub, "--vehicle", command->vehicle,
           "Vehicle file, whose track gives the yaw rate from the speeds of left and right wheels");
  add_choice(*sub, "--trial", command->trial, kTrialKindNames,
             "Kind of the file: log (default), or the kind of a table with one row per run");
  add_file(
      *sub, "-o,--output", command->output,
      "JSON file to write, with the mapping for --columns-file or the key columns of a vehicle")
      ->check(not_standard_output());
}

}  // namespace awmr::cli
