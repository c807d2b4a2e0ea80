#include "awmr/simulate/simulate.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/json/json_document.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/run_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/simulate/validity.h"
#include "commands.h"
#include "gains_origin.h"
#include "inputs.h"
#include "option_values.h"
#include "unstable_gains.h"

namespace awmr::cli {
namespace {

struct SimulateCommand {
  fs::path model;
  std::optional<fs::path> gains;
  fs::path scenario;
  YawMode mode = YawMode::kCombined;
  fs::path output;
  AllocationChoice allocation = {};
  HeadingRateChoice heading_rate_limit = {};
  PlantChoice plant = {};
};

/// Describes whether the run reached the end of its path; empty for guidance without end.
std::string end_of(const Run& run, const Scenario& scenario) {
  if (run.end == RunEnd::kNoPassage) {
    return "  no passage: obstacles block the way to the guidance target; stopped\n";
  }
  const bool ends = std::holds_alternative<WaypointPath>(scenario.guidance) ||
                    std::holds_alternative<LinePath>(scenario.guidance);
  if (!ends) return "";
  if (run.end == RunEnd::kDuration) return "  did not reach the end of its path in time\n";
  if (run.missed_waypoints == 0) return "  reached the end of its path\n";
  return fmt::format("  reached the end of its path, {} waypoint(s) missed\n",
                     run.missed_waypoints);
}

/// Describes how often the position estimate was reset to a GPS fix; empty if never.
std::string resets_of(const Run& run) {
  if (run.position_resets == 0) return "";
  return fmt::format(
      "  the position estimate was reset {} time(s) to a GPS fix, after several rejected fixes\n",
      run.position_resets);
}

std::string summary_of(const Run& run, const Scenario& scenario, const SimulateCommand& command) {
  const State<double>& last = run.rows.back().state;
  const std::string plant =
      scenario.tyres ? fmt::format("  plant: {}\n", plant_text(scenario)) : "";
  return fmt::format(
             "{}, {}: {} rows, {} RK4 steps per sample\n"
             "  at {:g} s: x {:.3f} m, y {:.3f} m, psi {:.2f} deg, u {:.3f} m/s, r {:.2f} deg/s\n",
             scenario.name, name_of(command.mode), run.rows.size(), run.substeps,
             run.rows.back().t_s, last.x_m, last.y_m, degrees(last.psi_rad), last.u_mps,
             degrees(last.r_radps)) +
         plant + end_of(run, scenario) + resets_of(run);
}

/// Returns the main metrics as text. Metrics that the run does not have are omitted.
std::string figures_of(const Metrics& metrics) {
  std::string text;
  const auto add = [&text](const char* name, const std::optional<double>& value, const char* unit) {
    if (value)
      text += fmt::format("{}{} {:.3f} {}", text.empty() ? "  " : ", ", name, *value, unit);
  };
  add("settled after", metrics.settling_time_s, "s");
  add("overshoot", metrics.overshoot_deg, "deg");
  add("cross-track RMS", metrics.cross_track_rms_m, "m");
  add("least clearance", metrics.clearance_min_m, "m");
  add("electrical work", metrics.electric_work_j, "J");
  return text.empty() ? text : text + "\n";
}

constexpr NameTable<RunEnd, 4> kRunEndNames{{{"duration", RunEnd::kDuration},
                                             {"finished", RunEnd::kFinished},
                                             {"no-passage", RunEnd::kNoPassage},
                                             {"failed", RunEnd::kFailed}}};

/// Returns the results of the run as JSON: the metrics under their names in comparison.csv, and the
/// last row under the column names of run.csv.
std::string document_of(const Run& run, const Scenario& scenario, YawMode mode,
                        const Metrics& metrics) {
  Json json;
  json["scenario"] = scenario.name;
  json["mode"] = name_of(mode);
  json["plant"] = plant_text(scenario);
  json["rows"] = run.rows.size();
  json["substeps"] = run.substeps;
  json["end"] = name_in(kRunEndNames, run.end);
  json["missed_waypoints"] = run.missed_waypoints;
  if (estimates_position(scenario)) json["position_resets"] = run.position_resets;
  json["completed"] = metrics.completed;
  for (const auto& [name, value] : named_metrics(metrics)) {
    json["metrics"][std::string(name)] = value ? Json(*value) : Json(nullptr);
  }
  for (const auto& [name, value] : named_values(run.rows.back(), scenario)) {
    json["last_row"][std::string(name)] = value;
  }
  return awmr::to_text(json);
}

Result<Provenance> provenance_of(const SimulateCommand& command, const Scenario& scenario,
                                 const std::vector<fs::path>& paths) {
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs, input_files(paths));
  NamedOptions options;
  describe_allocation(command.allocation, options);
  options.emplace_back("mode", std::string(name_of(command.mode)));
  describe_rate(command.heading_rate_limit, options);
  describe_plant(command.plant, std::span(&scenario, 1), options);
  return Provenance{"simulate", std::move(options), std::move(inputs)};
}

/// True if a second file with the origin of the run (.csv.json) is written: not if the output is a
/// pipe or a device.
bool has_side_file(const fs::path& output) {
  std::error_code ignored;
  const fs::file_status status = fs::status(output, ignored);
  return !fs::exists(status) || fs::is_regular_file(status);
}

/// Returns the paths of the input files, after checking the outputs. Errors (input): an output
/// cannot be written, or is an input.
Result<std::vector<fs::path>> checked_inputs(const SimulateCommand& command) {
  std::vector<fs::path> inputs =
      all_paths(command.model, command.scenario, command.gains, command.plant.tyres_file);
  AWMR_RETURN_IF_ERROR(check_output(command.output, inputs));
  if (has_side_file(command.output)) {
    AWMR_RETURN_IF_ERROR(check_output(run_side_path(command.output), inputs));
    AWMR_RETURN_IF_ERROR(check_run_side(run_side_path(command.output)));
  }
  return inputs;
}

/// Returns the gains in the file of `--gains`. If that option is not given, an open-loop scenario
/// gets the paper's gains, which have no effect there. For any other scenario, the missing option
/// is an error (input).
Result<Gains<double>> gains_for(const SimulateCommand& command, const Scenario& scenario,
                                const Model& model) {
  if (command.gains) {
    AWMR_ASSIGN_OR_RETURN(const ModeGains gains,
                          read_gains_for(*command.gains, model.vehicle.sample_time_s));
    return gains.in(command.mode);
  }
  if (std::holds_alternative<OpenLoop>(scenario.guidance)) return kPaperGains;
  return input_error(ErrorCode::kMissing, "--gains",
                     "the controller of this scenario needs gains: give --gains GAINS.json");
}

/// Adds the findings about the run, except the one about `--tyres`, which tyres_of() has already
/// added.
Status note_run(const SimulateCommand& command, const Scenario& scenario, const Model& model,
                const Gains<double>& gains, const Metrics& metrics,
                std::vector<Finding>& findings) {
  if (command.gains) {
    AWMR_RETURN_IF_ERROR(note_other_model(*command.gains, command.model, findings, command.mode));
    note_unstable(model, gains, *command.gains, {&scenario, 1}, findings, command.mode);
  }
  std::ranges::move(unattainable_requests(scenario, model), std::back_inserter(findings));
  if (auto finding = tyres_differ(scenario, model)) findings.push_back(*finding);
  if (auto finding = extrapolation_finding(
          model.file, measured_yaw_rate_degps(model), metrics.yaw_rate_max_degps,
          fmt::format("{}, {}", scenario.name, name_of(command.mode)), turn_commands(scenario))) {
    findings.push_back(*std::move(finding));
  }
  return {};
}

/// Writes the run and, if the output has one, the file with its origin (.csv.json).
Status write_run(const fs::path& output, const std::string& csv, Outcome& outcome) {
  if (!has_side_file(output)) return write_file(output, csv, check_run_text);
  // The file with the origin comes last, because it contains the hash of the run.
  const OutputFile files[] = {{output, csv, check_run_text},
                              {run_side_path(output), outcome.document, check_json_text}};
  AWMR_RETURN_IF_ERROR(write_files(files));
  outcome.written.push_back(files[1].path);
  return {};
}

Result<Outcome> execute(const SimulateCommand& command) {
  AWMR_ASSIGN_OR_RETURN(Model model, read_model(command.model));
  AWMR_ASSIGN_OR_RETURN(Scenario scenario, read_scenario(command.scenario));
  choose(command.allocation, model, std::span(&scenario, 1));
  std::vector<Finding> findings;
  AWMR_ASSIGN_OR_RETURN(const Tyres<double> tyres, tyres_of(command.plant, findings));
  AWMR_RETURN_IF_ERROR(choose(command.plant, tyres, std::span(&scenario, 1)));
  AWMR_RETURN_IF_ERROR(
      limit_heading_rate(command.heading_rate_limit, model, std::span(&scenario, 1)));
  const std::string equipment = equipment_text(model.vehicle, std::span(&scenario, 1));
  scenario = equipped(model.vehicle, std::move(scenario));
  AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> inputs, checked_inputs(command));
  AWMR_ASSIGN_OR_RETURN(const Gains<double> gains, gains_for(command, scenario, model));
  AWMR_ASSIGN_OR_RETURN(const Run run, simulate(model, gains, scenario, command.mode));
  AWMR_ASSIGN_OR_RETURN(const Controller<double> controller, controller_for(model, gains));
  Metrics metrics = metrics_of(run, scenario, controller);
  metrics.electric_work_j = electric_work_j(metrics, model.vehicle, controller.mass_norm);
  AWMR_RETURN_IF_ERROR(note_run(command, scenario, model, gains, metrics, findings));
  AWMR_ASSIGN_OR_RETURN(const Provenance provenance, provenance_of(command, scenario, inputs));
  const std::string csv = run_csv(run, scenario);
  Outcome outcome{.summary = summary_of(run, scenario, command) + figures_of(metrics) + equipment +
                             fmt::format("wrote {}\n", command.output.string()),
                  .findings = findings,
                  .document = run_side_text(
                      csv, provenance, document_of(run, scenario, command.mode, metrics), findings),
                  .written = {command.output}};
  AWMR_RETURN_IF_ERROR(write_run(command.output, csv, outcome));
  return outcome;
}

}  // namespace

void add_simulate(CLI::App& app, Session& session) {
  auto command = std::make_shared<SimulateCommand>();
  CLI::App* sub =
      add_command(app, session, "simulate", "Run one scenario in one yaw-control mode",
                  "awmr simulate --model model.json --gains gains.json --scenario "
                  "configs/paper/scenarios/c3_heading_steps.json --mode combined -o run.csv",
                  [command] { return execute(*command); });
  add_file(*sub, "--model", command->model, "model.json from identify")->required();
  add_file(*sub, "--gains", command->gains,
           "gains.json from tune; not needed for an open-loop scenario");
  add_file(*sub, "--scenario", command->scenario, "scenario.json")->required();
  add_choice(*sub, "--mode", command->mode, kYawModeNames,
             "Yaw control by wheel forces, by steering or by both")
      ->required();
  add_allocation(*sub, command->allocation);
  add_heading_rate_limit(*sub, command->heading_rate_limit, kNoRate);
  add_plant(*sub, command->plant);
  add_output(*sub, command->output, "run.csv to write");
}

}  // namespace awmr::cli
