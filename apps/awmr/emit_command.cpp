#include "awmr/emit/emit.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/json/json_document.h"
#include "awmr/core/option_text.h"
#include "awmr/emit/manifest.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/model/plausibility.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/validity.h"
#include "commands.h"
#include "emit_options.h"
#include "gains_origin.h"
#include "inputs.h"
#include "option_values.h"
#include "unstable_gains.h"

namespace awmr::cli {
namespace {

/// Writes each file to its path below the directory of `-o`, and creates directories as needed.
/// Writes all files or none. Errors: those of make_directory(), check_output() and write_files().
Status write_emitted(const EmitCommand& command, const std::vector<EmittedFile>& files,
                     const std::string& manifest) {
  const fs::path inputs[] = {command.model, command.gains};
  AWMR_RETURN_IF_ERROR(make_directory(command.output));
  std::vector<OutputFile> outputs;
  for (const EmittedFile& file : files) {
    const fs::path path = command.output / file.path;
    AWMR_RETURN_IF_ERROR(make_directory(path.parent_path()));
    AWMR_RETURN_IF_ERROR(check_output(path, inputs));
    outputs.push_back({path, file.bytes});
  }
  outputs.push_back({command.output / kManifest, manifest, check_json_text});
  AWMR_RETURN_IF_ERROR(check_output(outputs.back().path, inputs));
  return write_files(outputs);
}

std::vector<fs::path> paths_of(const EmitCommand& command, const std::vector<EmittedFile>& files) {
  std::vector<fs::path> paths;
  for (const EmittedFile& file : files) paths.push_back(command.output / file.path);
  paths.push_back(command.output / kManifest);
  return paths;
}

/// `unit`: of the speed or yaw rate. `unit_of_resistance`: divided by F_max.
std::string table_line(const char* name, const char* unit, const char* unit_of_resistance,
                       const EmittedTable& table) {
  return fmt::format(
      "  {} resistance table: {} entries up to {:g} {}; largest error {:.1e}{} where the "
      "resistance is below {:g}{},\n"
      "    relative {:.1e} above\n",
      name, table.lines.size(), table.top_speed, unit, table.worst_error, unit_of_resistance,
      table.split, unit_of_resistance, table.worst_relative_error);
}

Json table_json(const EmittedTable& table) {
  return {{"lines", table.lines.size()},
          {"top_speed", table.top_speed},
          {"split", table.split},
          {"worst_error", table.worst_error},
          {"worst_relative_error", table.worst_relative_error}};
}

/// Adds a warning if a resistance table is less accurate than the default bound. If the user gave a
/// bound, there is no warning: a table that misses it is an error.
void add_coarse(const char* name, const EmittedTable& table, const EmitCommand& command,
                Outcome& outcome) {
  if (command.emit.table_error || table.largest_relative_error() <= kTableError) return;
  outcome.findings.push_back(
      {command.model.filename().string(), 0, Severity::kWarning, "coarse-table",
       fmt::format(
           "the {} resistance is so steep at low speed that its most accurate table has an error "
           "of {:.2g} % (usual: at most {:g} %). The feed-forward on the chip has the same error; "
           "if the resistance is a power law, --resistance powf avoids the table",
           name, 100.0 * table.largest_relative_error(), 100.0 * kTableError)});
}

/// Warns of gains that are too weak to hold a heading: if left and right motors differ by 16 %, the
/// steady heading error exceeds kMaxOnCourse_rad/2, half of the largest error that the sketches
/// accept without fault 17.
void add_weak_heading(const AutopilotParameters& parameters, const EmitCommand& command,
                      Outcome& outcome) {
  if (2.0 * parameters.steady_error_rad <= kMaxOnCourse_rad) return;
  outcome.findings.push_back(
      {command.gains.string(), 0, Severity::kWarning, "weak-heading",
       fmt::format(
           "the heading loop is so weak (small lambda mu/epsilon) that motors whose forces differ "
           "by 16 % turn the vehicle {:.0f} deg off its heading; above 45 deg the sketches report "
           "fault 17 and disarm. Use faster gains, or the gains of awmr tune --observer",
           degrees(parameters.steady_error_rad))});
}

/// Warns of a sample time that the firmware cannot use: shorter than the chip's longest step with
/// the compiled parts, or longer than the permitted time between two steps or than half of the
/// heading timeout.
std::vector<Finding> sample_time(double sample_time_s, const ModeGains& gains,
                                 const EmitCommand& command) {
  const double longest_step_s =
      longest_step_cycles(parts_with(command.emit.parts, gains), command.emit.resistance) /
      kChipClock_Hz;
  const double oldest_s = 1e-3 * command.emit.heading_timeout_ms;
  std::vector<Finding> findings;
  const auto add = [&](std::string message) {
    findings.push_back({command.model.filename().string(), 0, Severity::kWarning,
                        "sample-time-of-the-chip", std::move(message)});
  };
  if (sample_time_s < longest_step_s) {
    add(
        fmt::format("sample_time_s is {:g} s, but a control step with these parts takes up to "
                    "{:.2g} s on the ATmega2560: give vehicle.json a longer sample_time_s and "
                    "identify again, compile in fewer parts, or use a faster board",
                    sample_time_s, longest_step_s));
  }
  const std::uint32_t step_ms = command.emit.step_timeout_ms;
  if (step_ms != 0 && sample_time_s > 1e-3 * step_ms) {
    add(fmt::format(
        "sample_time_s is {:g} s, longer than the permitted time between two steps, {} ms, so "
        "that every step would raise a fault: set {} to at least two sample times",
        sample_time_s, step_ms, option_text("step-timeout-ms")));
  }
  if (sample_time_s > 0.5 * oldest_s) {
    add(
        fmt::format("sample_time_s is {:g} s, more than half of the largest permitted age of a "
                    "heading, {:g} s, so that a single missed heading raises a fault: set {} to "
                    "at least two sample times",
                    sample_time_s, oldest_s, option_text("heading-timeout-ms")));
  }
  return findings;
}

/// Checks the dimensions of the vehicle, unless --as-is is given. Errors (input): each implausible
/// value, with its place in the model's file.
Status check_vehicle(const EmitCommand& command, const Vehicle& vehicle) {
  if (command.as_is) return {};
  return check_plausible(
      vehicle, command.model.string() + ":/vehicle",
      "Correct vehicle.json and identify again, or give " + option_text("as-is"));
}

/// Warns of weak gains, and adds the accuracy of the resistance tables to the output. With
/// --resistance powf there are no tables.
Status add_parameters(const Model& model, const ModeGains& gains, const EmitInputs& inputs,
                      const EmitCommand& command, Outcome& outcome) {
  AWMR_ASSIGN_OR_RETURN(const auto parameters,
                        autopilot_parameters(model, gains, inputs, command.emit));
  add_weak_heading(parameters, command, outcome);
  if (command.emit.resistance != ResistanceForm::kTable) return {};
  add_coarse("surge", parameters.surge, command, outcome);
  add_coarse("yaw", parameters.yaw, command, outcome);
  outcome.summary += table_line("surge", "m/s", " F_max", parameters.surge) +
                     table_line("yaw", "rad/s", " m F_max", parameters.yaw);
  Json json;
  json["tables"]["surge"] = table_json(parameters.surge);
  json["tables"]["yaw"] = table_json(parameters.yaw);
  outcome.document = awmr::to_text(json);
  return {};
}

void add_line_law(CLI::App& command, EmitOptions& options) {
  const std::vector<std::string> laws = line_law_names();
  const auto set = [&options, laws](const std::string& name) {
    options.line_law = static_cast<std::size_t>(std::ranges::find(laws, name) - laws.begin());
    options.parts.insert(FirmwarePart::kLine);
  };
  command
      .add_option_function<std::string>(
          "--line-law", set,
          "Compile in the part 'line' (following lines) with this guidance law [" + laws.front() +
              "]")
      ->check(one_of(laws));
}

}  // namespace

Result<Outcome> execute(const EmitCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const Model model, command.as_is ? read_model_as_is(command.model)
                                                         : read_model(command.model));
  AWMR_RETURN_IF_ERROR(check_vehicle(command, model.vehicle));
  AWMR_ASSIGN_OR_RETURN(const ModeGains gains,
                        read_gains_for(command.gains, model.vehicle.sample_time_s));
  AWMR_ASSIGN_OR_RETURN(const EmitInputs inputs, emit_inputs(command.model, command.gains));
  std::vector<EmittedFile> files;
  Outcome outcome{.summary =
                      fmt::format("wrote {}{}\n", (command.output / "awmr_params.h").string(),
                                  command.header_only ? "" : " and the Arduino library around it")};
  if (command.header_only) {
    AWMR_ASSIGN_OR_RETURN(std::string header, params_header(model, gains, inputs));
    files.push_back({"awmr_params.h", std::move(header)});
  } else {
    AWMR_ASSIGN_OR_RETURN(files, firmware_library(model, gains, inputs, command.emit));
    AWMR_RETURN_IF_ERROR(add_parameters(model, gains, inputs, command, outcome));
  }
  AWMR_RETURN_IF_ERROR(check_replaceable(command.output, files));
  AWMR_RETURN_IF_ERROR(note_other_model(command.gains, command.model, outcome.findings));
  if (auto finding = missing_intervals(model)) outcome.findings.push_back(*std::move(finding));
  const double sample_time_s = model.vehicle.sample_time_s;
  std::ranges::move(sample_time(sample_time_s, gains, command),
                    std::back_inserter(outcome.findings));
  note_unstable(model, gains, command.gains, outcome.findings);
  if (const auto plant = model.plant(Motion::kStraight)) {
    if (auto finding =
            unsigned_speed_finding(*plant, model.vehicle, gains, command.gains.string())) {
      outcome.findings.push_back(std::move(*finding));
    }
  }
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> origin, input_files({command.model, command.gains}));
  const Provenance provenance{
      "emit", {{"header_only", command.header_only ? "true" : "false"}}, std::move(origin)};
  outcome.document =
      manifest_text(command.output, files, provenance, outcome.document, outcome.findings);
  AWMR_RETURN_IF_ERROR(write_emitted(command, files, outcome.document));
  outcome.written = paths_of(command, files);
  return outcome;
}

void add_emit(CLI::App& app, Session& session) {
  auto command = std::make_shared<EmitCommand>();
  CLI::App* sub =
      add_command(app, session, "emit", "Write awmr_params.h and the Arduino library around it",
                  "awmr emit --model model.json --gains gains.json -o firmware",
                  [command] { return execute(*command); });
  add_file(*sub, "--model", command->model, "model.json from identify")->required();
  add_file(*sub, "--gains", command->gains, "gains.json from tune")->required();
  sub->add_flag("--header-only", command->header_only,
                "Write only awmr_params.h, without the library");
  sub->add_flag("--as-is", command->as_is, "Accept implausible dimensions of the vehicle");
  add_emit_options(*sub, command->emit);
  add_line_law(*sub, command->emit);
  add_output_directory(*sub, command->output, "Directory for awmr_params.h and the library");
}

}  // namespace awmr::cli
