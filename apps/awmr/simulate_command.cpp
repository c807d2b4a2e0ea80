#include "awmr/simulate/simulate.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/metrics.h"
#include "commands.h"

namespace awmr::cli {

Result<Outcome> execute(const SimulateCommand& command) {
  const auto model = read_model(command.model);
  if (!model) return tl::unexpected(model.error());
  const auto plant = model->plant(command.model.string());
  if (!plant) return tl::unexpected(plant.error());
  const auto scenario = read_scenario(command.scenario);
  if (!scenario) return tl::unexpected(scenario.error());
  Gains<double> gains = kPaperGains;
  if (command.gains) {
    const auto read = read_gains(*command.gains);
    if (!read) return tl::unexpected(read.error());
    gains = *read;
  } else if (!std::holds_alternative<OpenLoop>(scenario->guidance)) {
    return input_error("--gains", "this scenario closes the loop: give --gains GAINS.json");
  }
  const Controller<double> controller = make_controller(*plant, model->vehicle, gains);
  const Run run = simulate(*plant, controller, *scenario, command.mode,
                           {.sample_time_s = model->vehicle.sample_time_s, .substeps = {}});
  if (const auto written = write_file(command.output, run_csv(run)); !written) {
    return tl::unexpected(written.error());
  }
  const State<double>& last = run.rows.back().state;
  const std::string summary = fmt::format(
      "{}, {}: {} rows, {} RK4 steps per sample\n"
      "  at {:g} s: x {:.3f} m, y {:.3f} m, psi {:.2f} deg, u {:.3f} m/s, r {:.2f} deg/s\nwrote "
      "{}\n",
      scenario->name, name_of(command.mode), run.rows.size(), run.substeps, run.rows.back().t_s,
      last.x_m, last.y_m, degrees(last.psi_rad), last.u_mps, degrees(last.r_radps),
      command.output.string());
  return Outcome{.summary = summary};
}

void add_simulate(CLI::App& app, Session& session) {
  static const std::map<std::string, YawMode> modes{{"differential", YawMode::kDifferential},
                                                    {"steering", YawMode::kSteering},
                                                    {"combined", YawMode::kCombined}};
  auto command = std::make_shared<SimulateCommand>();
  CLI::App* sub =
      add_command(app, session, "simulate", "Run one scenario in one yaw-control mode",
                  "awmr simulate --model model.json --gains gains.json --scenario "
                  "configs/paper/scenarios/c3_heading_steps.json --mode combined -o run.csv",
                  [command] { return execute(*command); });
  sub->add_option("--model", command->model, "model.json from identify")->required();
  sub->add_option("--gains", command->gains, "gains.json; not needed in open loop");
  sub->add_option("--scenario", command->scenario, "scenario.json")->required();
  sub->add_option("--mode", command->mode, "differential, steering or combined")
      ->required()
      ->transform(CLI::CheckedTransformer(modes));
  add_output(*sub, command->output, "run.csv to write");
}

}  // namespace awmr::cli
