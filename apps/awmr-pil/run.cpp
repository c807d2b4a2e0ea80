#include "run.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "awmr/core/file.h"
#include "awmr/core/json/json_document.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/scenario_file.h"
#include "emit_options.h"
#include "emulator.h"
#include "executor.h"
#include "firmware_build.h"
#include "gains_origin.h"
#include "injections.h"
#include "loop.h"
#include "report.h"
#include "work_folder.h"

namespace awmr::pil {
namespace {

namespace fs = std::filesystem;
using cli::Injection;
using cli::PilOptions;

/// Contents of the input files, and values derived from them.
struct Inputs {
  Model model;
  EmitOptions emit;  ///< the options, with the parts that the scenario needs
  ModeGains gains;
  EmitInputs names;
  LoopSetup setup;
  AutopilotParameters parameters;
};

/// Checks the sample time for --link memory. Errors (input): it is too short or too long for the
/// timer of pil_memory.cpp, which has 16 bits and counts at an eighth of the clock frequency.
Status check_sample_time(const Model& model) {
  // Rounded in float, as in the firmware, so that both find the same number of counts.
  const float counts = static_cast<float>(model.vehicle.sample_time_s) * 2e6F + 0.5F;
  if (counts >= 2.0F && counts < 65537.0F) return {};
  return input_error(
      ErrorCode::kOutOfRange, model.file + ":/vehicle/sample_time_s",
      fmt::format(
          "the emulated chip's timer allows sample times from 1 us to {:.6g} ms, found {:.6g} "
          "ms; identify the vehicle with such a sample time, or use --link uart",
          65536.0 * 8.0 / kChipClock_Hz * 1000.0, model.vehicle.sample_time_s * 1000.0));
}

/// Adds to `given` the firmware options that the scenario's guidance and its split of the yaw
/// moment need.
EmitOptions emit_options_for(EmitOptions given, const Scenario& scenario, const Mission& mission) {
  given.parts.merge(parts_of(mission));
  if (mission.line) given.line_law = mission.line->place;
  if (scenario.control.split != CombinedSplit::kRedistribute) given.split = mission.split;
  return given;
}

GpsLimits gps_limits_of(const AutopilotParameters& parameters) {
  const auto& safety = parameters.block.safety;
  return {.speed_max_mps = safety.speed_max_mps,
          .on_course_rad = parameters.on_course_rad,
          .off_course_mrad = parameters.off_course_mrad,
          .timeout_ms = safety.speed_timeout_ms};
}

Result<Inputs> read_inputs(const PilOptions& options) {
  Inputs in;
  AWMR_ASSIGN_OR_RETURN(in.model, read_model(options.model));
  const Vehicle& vehicle = in.model.vehicle;
  AWMR_ASSIGN_OR_RETURN(in.gains, read_gains_for(options.gains, vehicle.sample_time_s));
  AWMR_ASSIGN_OR_RETURN(Scenario scenario, read_scenario(options.scenario));
  scenario = equipped(vehicle, std::move(scenario));
  AWMR_RETURN_IF_ERROR(check_scenario(scenario, options.scenario.string()));
  if (options.link == cli::PilLink::kMemory) AWMR_RETURN_IF_ERROR(check_sample_time(in.model));
  AWMR_RETURN_IF_ERROR(check_mode(vehicle, options.mode));
  AWMR_ASSIGN_OR_RETURN(const auto plant, plant_for(scenario, in.model));
  AWMR_ASSIGN_OR_RETURN(in.names, cli::emit_inputs(options.model, options.gains));
  if (estimates_position(scenario)) know_receiver(*scenario.sensors->gps, in.model);
  const Mission mission = mission_of(scenario);
  in.emit = emit_options_for(options.emit, scenario, mission);
  AWMR_ASSIGN_OR_RETURN(in.parameters, autopilot_parameters(in.model, in.gains, in.names, in.emit));
  in.emit.parts = in.parameters.parts;
  in.setup = {.plant = plant,
              .sample_time_s = vehicle.sample_time_s,
              .force_max = vehicle.wheel_force.hi,
              .scenario = scenario,
              .mission = mission,
              .mode = options.mode,
              .injection = options.injection,
              .limits = in.parameters.block.safety,
              .gps_limits = gps_limits_of(in.parameters)};
  return in;
}

/// Runs the closed loop with the control step in float on this machine. `form`: whether resistances
/// are computed by tables or by powf. `resets`: numbers of the steps before which the controller is
/// reset.
Result<std::vector<LoopRow>> run_host(const Inputs& in, ResistanceForm form,
                                      const std::vector<std::size_t>& resets = {}) {
  AutopilotParameters parameters = in.parameters;
  if (form != in.emit.resistance) {
    EmitOptions options = in.emit;
    options.resistance = form;
    AWMR_ASSIGN_OR_RETURN(parameters, autopilot_parameters(in.model, in.gains, in.names, options));
  }
  if (in.setup.injection == Injection::kParameters) parameters.crc ^= 1U;
  const auto host = host_executor(parameters, in.setup.mission);
  AWMR_RETURN_IF_ERROR(host->start());
  LoopSetup setup = in.setup;
  setup.resets = resets;
  return run_loop(setup, *host);
}

/// Sets the step at which the injection begins: the middle of the run. The number of steps comes
/// from a simulation of the same run without injection.
Status place_injection(Inputs& in) {
  Inputs undisturbed = in;
  undisturbed.setup.injection = Injection::kNone;
  AWMR_ASSIGN_OR_RETURN(const auto rows, run_host(undisturbed, in.emit.resistance));
  in.setup.middle = rows.size() / 2;
  if (in.setup.injection == Injection::kReset) in.setup.resets = {in.setup.middle};
  return {};
}

Result<std::unique_ptr<Chip>> connect(const PilOptions& options, const Inputs& in,
                                      const fs::path& elf) {
  const bool damage = options.injection == Injection::kParameters;
  if (options.line_noise > 0.0 && (options.port || options.link != cli::PilLink::kUart)) {
    return input_error(ErrorCode::kConflict, "--line-noise",
                       "acts only on the emulated chip's serial line; add --link uart and remove "
                       "--port, or remove this option");
  }
  if (options.port) {
    if (options.link != cli::PilLink::kUart) {
      return input_error(ErrorCode::kConflict, "--port",
                         "needs --link uart, because a board's memory cannot be accessed; add it");
    }
    if (damage) {
      return input_error(ErrorCode::kConflict, "--inject",
                         "the fault 'parameters' can be injected only on the emulated chip; "
                         "remove --port");
    }
    return port_link(*options.port, options.baud, elf,
                     in.parameters.crc ^ mission_crc(in.setup.mission));
  }
  if (options.link == cli::PilLink::kUart)
    return uart_link(elf, damage, in.parameters.crc ^ mission_crc(in.setup.mission),
                     options.line_noise);
  return memory_link(elf, damage);
}

/// Searches for the slowest step of an emulated chip with hostile inputs. Call it after the run of
/// the scenario.
Result<std::optional<Hostile>> hostile_of(const PilOptions& options, const Inputs& in, Chip& chip,
                                          const Watch& watch) {
  if (options.port || options.injection != Injection::kNone || options.hostile_steps == 0) {
    return std::optional<Hostile>();
  }
  watch.doing("searching for the longest step");
  const auto host = host_executor(in.parameters, in.setup.mission);
  AWMR_RETURN_IF_ERROR(host->start());
  AWMR_ASSIGN_OR_RETURN(
      const Hostile hostile,
      provoke(chip, *host, in.parameters.block.safety, in.setup.mission,
              {options.hostile_steps, estimates_position(in.setup.scenario)}, watch.progress));
  return std::optional(hostile);
}

/// Returns the time from which durations are computed, s: the processor time of this process for an
/// emulated chip, the wall-clock time for a real board.
double elapsed_s(bool emulated) {
  timespec now{};
  ::clock_gettime(emulated ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Result<ChipRun> run_chip(const PilOptions& options, const Inputs& in, const Watch& watch) {
  if (options.build_directory) AWMR_RETURN_IF_ERROR(prepare_to_keep(*options.build_directory));
  AWMR_ASSIGN_OR_RETURN(const auto folder, WorkFolder::make());
  watch.doing("compiling the firmware");
  AWMR_ASSIGN_OR_RETURN(const auto library,
                        firmware_library(in.model, in.gains, in.names, in.emit));
  AWMR_ASSIGN_OR_RETURN(
      const fs::path elf,
      build_firmware(
          folder->path(), library,
          {.link = options.link == cli::PilLink::kMemory ? LinkKind::kMemory : LinkKind::kUart,
           .optimize = *options.optimize,
           .mission = mission_header(in.setup.mission),
           .is_directed = has_unsigned_speed(in.setup.scenario),
           .is_estimated = estimates_position(in.setup.scenario)}));
  if (options.build_directory) {
    AWMR_RETURN_IF_ERROR(keep_firmware(folder->path(), *options.build_directory));
  }
  AWMR_ASSIGN_OR_RETURN(const std::unique_ptr<Chip> chip, connect(options, in, elf));
  ChipRun run;
  AWMR_ASSIGN_OR_RETURN(run.start_fault, chip->start());
  watch.doing(options.port ? "running on the board" : "running on the emulated chip");
  const double before_s = elapsed_s(!options.port);
  AWMR_ASSIGN_OR_RETURN(run.rows, run_loop(in.setup, *chip, watch.progress));
  const double taken_s = elapsed_s(!options.port) - before_s;
  run.real_time_factor = static_cast<double>(run.rows.size()) * in.setup.sample_time_s / taken_s;
  AWMR_ASSIGN_OR_RETURN(run.hostile, hostile_of(options, in, *chip, watch));
  run.figures = chip->figures();
  return run;
}

/// Fills in default values for options that were not given. These defaults depend on the scenario
/// and the firmware.
PilOptions resolved(PilOptions options, const Inputs& in) {
  const std::set<FirmwarePart>& parts = in.emit.parts;
  const bool avoids = parts.contains(FirmwarePart::kAvoidance);
  const std::size_t count = parts.size() + (estimates_position(in.setup.scenario) ? 1 : 0);
  options.emit = in.emit;
  if (!options.optimize) {
    const bool large = avoids || parts.contains(FirmwarePart::kPath) || count > 1;
    options.optimize = large ? cli::Optimize::kSize : cli::Optimize::kSpeed;
  }
  if (!options.cycles_max) {
    const bool by_table = in.emit.resistance == ResistanceForm::kTable;
    const double period_cycles = in.setup.sample_time_s * kChipClock_Hz;
    options.cycles_max =
        count == 0 ? (by_table ? 13000U : 24000U) : static_cast<unsigned>(0.75 * period_cycles);
  }
  if (!options.heading_max_deg) {
    options.heading_max_deg = avoids || in.setup.scenario.sensors ? 2.0 : 0.05;
  }
  return options;
}

Status compare_runs(const PilOptions& options, const Inputs& in, Report& report) {
  report.restarts = restarts_of(report.chip.rows);
  AWMR_ASSIGN_OR_RETURN(const std::vector<LoopRow> twin,
                        run_host(in, options.emit.resistance, report.restarts));
  report.from_float = difference(report.chip.rows, twin);
  if (options.injection != Injection::kNone) {
    report.injected = injected_of(in.setup, report.chip.rows);
    return {};
  }
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, in.model.plant());
  const Run exact =
      simulate(in.setup.plant,
               make_controller(plant, in.model.vehicle, in.gains.in(in.setup.mode), in.emit.split),
               in.setup.scenario, in.setup.mode, {.sample_time_s = in.setup.sample_time_s});
  AWMR_RETURN_IF_ERROR(failure_of(exact, in.setup.scenario));
  report.from_double = difference(report.chip.rows, exact);
  report.heading_apart_deg = heading_apart_deg(report.chip.rows, exact);
  // The tables are compared with powf, which computes power laws only.
  if (!is_power_law(plant)) return {};
  AWMR_ASSIGN_OR_RETURN(const std::vector<LoopRow> by_powf, run_host(in, ResistanceForm::kPowf));
  report.by_float32 = difference(by_powf, exact);
  if (options.emit.resistance == ResistanceForm::kTable) {
    report.by_table = difference(twin, by_powf);
  }
  return {};
}

}  // namespace

Result<Outcome> run_pil(const PilOptions& requested, const Watch& watch) {
  const std::vector<fs::path> inputs{requested.model, requested.gains, requested.scenario};
  AWMR_RETURN_IF_ERROR(check_output(requested.output, inputs));
  AWMR_ASSIGN_OR_RETURN(Inputs in, read_inputs(requested));
  std::vector<Finding> findings;
  AWMR_RETURN_IF_ERROR(
      cli::note_other_model(requested.gains, requested.model, findings, requested.mode));
  if (requested.injection != Injection::kNone) AWMR_RETURN_IF_ERROR(place_injection(in));
  const PilOptions options = resolved(requested, in);
  Report report;
  AWMR_ASSIGN_OR_RETURN(report.chip, run_chip(options, in, watch));
  watch.doing("comparing with the host's runs");
  report.cycles = cycles_of(report.chip.rows);
  AWMR_RETURN_IF_ERROR(compare_runs(options, in, report));
  evaluate(options, in.setup.sample_time_s * kChipClock_Hz, report);
  AWMR_ASSIGN_OR_RETURN(const std::string text, report_text(options, in.setup, report));
  const std::string document = with_findings(text, findings);
  AWMR_RETURN_IF_ERROR(write_file(options.output, document, check_json_text));
  return Outcome{report_summary(options, in.setup, report), report.passed(), document, findings};
}

}  // namespace awmr::pil
