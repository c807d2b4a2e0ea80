#include "run.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "awmr/core/file.h"
#include "awmr/core/input_file.h"
#include "awmr/core/json.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/scenario_file.h"
#include "comparison.h"
#include "emit_options.h"
#include "emulator.h"
#include "executor.h"
#include "firmware_build.h"
#include "loop.h"
#include "work_folder.h"

namespace awmr::pil {
namespace {

namespace fs = std::filesystem;
using cli::Injection;
using cli::PilOptions;

/// What was read, and what follows from it.
struct Inputs {
  Model model;
  Gains<double> gains;
  EmitInputs names;
  LoopSetup setup;
  AutopilotParameters parameters;
};

/// The step of pil_memory.cpp is started by a timer that counts eighths of the clock in 16 bits.
Status check_sample_time(const Model& model) {
  // In float and rounded as the firmware does it.
  const float counts = static_cast<float>(model.vehicle.sample_time_s) * 2e6F + 0.5F;
  if (counts >= 2.0F && counts < 65537.0F) return {};
  return input_error(
      model.file + ":/vehicle/sample_time_s",
      fmt::format("the emulated chip's timer starts a step every 1 us to {:.6g} ms, found {:.6g} "
                  "ms; identify the vehicle with a sample time that the firmware can hold, or use "
                  "--link uart",
                  65536.0 * 8.0 / kClockHz * 1000.0, model.vehicle.sample_time_s * 1000.0));
}

Result<Inputs> read_inputs(const PilOptions& options) {
  Inputs in;
  auto model = read_model(options.model);
  if (!model) return tl::unexpected(model.error());
  const auto gains = read_gains(options.gains);
  if (!gains) return tl::unexpected(gains.error());
  const auto scenario = read_scenario(options.scenario);
  if (!scenario) return tl::unexpected(scenario.error());
  AWMR_RETURN_IF_ERROR(check_scenario(*scenario, options.scenario.string()));
  if (options.link == cli::PilLink::kMemory) AWMR_RETURN_IF_ERROR(check_sample_time(*model));
  const auto plant = plant_for(*scenario, *model);
  if (!plant) return tl::unexpected(plant.error());
  const auto names = cli::emit_inputs(options.model, options.gains);
  if (!names) return tl::unexpected(names.error());
  const auto parameters = autopilot_parameters(*model, *gains, *names, options.emit);
  if (!parameters) return tl::unexpected(parameters.error());
  in.setup = {.plant = *plant,
              .sample_time_s = model->vehicle.sample_time_s,
              .force_max = model->vehicle.wheel_force.hi,
              .scenario = *scenario,
              .mode = options.mode,
              .injection = options.injection};
  in.model = std::move(*model);
  in.gains = *gains;
  in.names = *names;
  in.parameters = *parameters;
  return in;
}

Result<std::unique_ptr<Chip>> connect(const PilOptions& options, const Inputs& in,
                                      const fs::path& elf) {
  const bool damage = options.injection == Injection::kParameters;
  if (options.port) {
    if (options.link != cli::PilLink::kUart) {
      return input_error("--port", "is for --link uart: memory is the emulated chip's only");
    }
    if (damage) return input_error("--inject", "parameters: only on the emulated chip");
    return port_link(*options.port, options.baud, elf, in.parameters.crc);
  }
  if (options.link == cli::PilLink::kUart) return uart_link(elf, damage, in.parameters.crc);
  return memory_link(elf, damage);
}

struct ChipRun {
  std::vector<LoopRow> rows;
  ChipFigures figures;
  std::uint8_t start_fault = 0;
  double real_time_factor = 0.0;
};

/// Of this process's processor time, which is what emulation takes on one core; with a real board
/// of the clock's.
double elapsed_s(bool emulated) {
  timespec now{};
  ::clock_gettime(emulated ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Result<ChipRun> run_chip(const PilOptions& options, const Inputs& in) {
  if (options.build_directory) AWMR_RETURN_IF_ERROR(prepare_to_keep(*options.build_directory));
  AWMR_ASSIGN_OR_RETURN(const auto folder, WorkFolder::make());
  const auto library = firmware_library(in.model, in.gains, in.names, options.emit);
  if (!library) return tl::unexpected(library.error());
  const auto elf =
      build_firmware(folder->path(), *library,
                     options.link == cli::PilLink::kMemory ? LinkKind::kMemory : LinkKind::kUart);
  if (!elf) return tl::unexpected(elf.error());
  if (options.build_directory) {
    AWMR_RETURN_IF_ERROR(keep_firmware(folder->path(), *options.build_directory));
  }
  auto chip = connect(options, in, *elf);
  if (!chip) return tl::unexpected(chip.error());
  const auto started = (*chip)->start();
  if (!started) return tl::unexpected(started.error());
  const double before_s = elapsed_s(!options.port);
  auto rows = run_loop(in.setup, **chip);
  if (!rows) return tl::unexpected(rows.error());
  const double taken_s = elapsed_s(!options.port) - before_s;
  ChipRun run;
  run.real_time_factor = static_cast<double>(rows->size()) * in.setup.sample_time_s / taken_s;
  run.rows = std::move(*rows);
  run.figures = (*chip)->figures();
  run.start_fault = *started;
  return run;
}

/// The same loop in float on this machine.
Result<std::vector<LoopRow>> run_host(const Inputs& in, ResistanceForm form,
                                      const EmitOptions& emit) {
  EmitOptions options = emit;
  options.resistance = form;
  auto parameters = autopilot_parameters(in.model, in.gains, in.names, options);
  if (!parameters) return tl::unexpected(parameters.error());
  if (in.setup.injection == Injection::kParameters) parameters->crc ^= 1U;
  const auto host = host_executor(*parameters);
  if (const auto started = host->start(); !started) return tl::unexpected(started.error());
  return run_loop(in.setup, *host);
}

/// One thing to be held against its bound.
struct Check {
  std::string name;
  double value = 0.0;
  double bound = 0.0;
  bool passed = false;
  std::string unit;
};

Check at_most(std::string name, double value, double bound, std::string unit) {
  return {std::move(name), value, bound, value <= bound, std::move(unit)};
}

/// What an injected fault did.
struct Injected {
  std::uint8_t expected = 0;
  std::uint8_t seen = 0xFF;  ///< bits that were set on every sample of the window
  bool safe = true;          ///< forces 0 and wheels straight over the whole window
  bool quiet = true;         ///< no fault outside the window
};

Injected injected_of(const LoopSetup& setup, const std::vector<LoopRow>& rows) {
  Injected result;
  result.expected = expected_fault(setup.injection);
  const Window window = injection_window(setup);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const AutopilotOutput& out = rows[i].step.output;
    if (i < window.first || i >= window.last) {
      result.quiet = result.quiet && out.fault == kFaultNone;
      continue;
    }
    result.seen &= out.fault;
    const bool still =
        std::max({std::abs(out.command.force.left), std::abs(out.command.force.right),
                  std::abs(out.command.steering_rad)}) <= 0.0F;
    result.safe = result.safe && still;
  }
  return result;
}

struct Report {
  ChipRun chip;
  Cycles cycles;
  Difference from_float;
  std::optional<Difference> from_double;  ///< absent with an injection
  std::optional<Difference> by_float32;   ///< float by powf against double
  std::optional<Difference> by_table;     ///< float by table against float by powf
  std::optional<Injected> injected;
  std::vector<Check> checks;

  bool passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed; });
  }
};

Status compare_runs(const PilOptions& options, const Inputs& in, Report& report) {
  const auto twin = run_host(in, options.emit.resistance, options.emit);
  if (!twin) return tl::unexpected(twin.error());
  report.from_float = difference(report.chip.rows, *twin);
  if (options.injection != Injection::kNone) {
    report.injected = injected_of(in.setup, report.chip.rows);
    return {};
  }
  const auto plant = in.model.plant();
  if (!plant) return tl::unexpected(plant.error());
  const Run exact = simulate(in.setup.plant, make_controller(*plant, in.model.vehicle, in.gains),
                             in.setup.scenario, in.setup.mode,
                             {.sample_time_s = in.setup.sample_time_s, .substeps = {}});
  AWMR_RETURN_IF_ERROR(failure_of(exact, in.setup.scenario));
  report.from_double = difference(report.chip.rows, exact);
  const auto by_powf = run_host(in, ResistanceForm::kPowf, options.emit);
  if (!by_powf) return tl::unexpected(by_powf.error());
  report.by_float32 = difference(*by_powf, exact);
  if (options.emit.resistance == ResistanceForm::kTable) {
    report.by_table = difference(*twin, *by_powf);
  }
  return {};
}

void judge(const PilOptions& options, Report& report) {
  const bool by_table = options.emit.resistance == ResistanceForm::kTable;
  const bool by_memory = options.link == cli::PilLink::kMemory;
  const ChipFigures& figures = report.chip.figures;
  std::vector<Check>& checks = report.checks;
  checks.push_back(at_most("cycles", report.cycles.max,
                           options.cycles_max.value_or(by_table ? 12000 : 24000), "cycles"));
  checks.push_back(at_most("flash", figures.flash_bytes,
                           options.flash_max.value_or(by_memory ? 8192 : 9216), "bytes"));
  checks.push_back(at_most("ram", figures.ram_bytes, options.ram_max, "bytes"));
  checks.push_back(at_most("difference from the host's float run", report.from_float.largest(),
                           options.difference_max.value_or(by_table ? 0.0 : 1e-6), ""));
  checks.push_back({"rows as in the host's float run", report.from_float.same_length ? 0.0 : 1.0,
                    0.0, report.from_float.same_length, ""});
  if (report.from_double) {
    checks.push_back(at_most("heading from the host's double run",
                             report.from_double->of("heading_deg"), options.heading_max_deg,
                             "deg"));
  }
  if (const auto& injected = report.injected) {
    const bool raised = (injected->seen & injected->expected) != 0;
    checks.push_back({"injected fault raised", raised ? 0.0 : 1.0, 0.0, raised, ""});
    checks.push_back({"safe command given", injected->safe ? 0.0 : 1.0, 0.0, injected->safe, ""});
    checks.push_back({"no other fault", injected->quiet ? 0.0 : 1.0, 0.0, injected->quiet, ""});
  } else {
    const bool clean = report.chip.start_fault == kFaultNone &&
                       std::all_of(report.chip.rows.begin(), report.chip.rows.end(),
                                   [](const LoopRow& row) { return row.step.output.fault == 0; });
    checks.push_back({"no fault", clean ? 0.0 : 1.0, 0.0, clean, ""});
  }
}

Json json_of(const Difference& difference) {
  Json json = Json::object();
  for (const auto& [name, value] : difference.signals) {
    if (std::isfinite(value)) {
      json[name] = value;
    } else {
      json[name] = nullptr;
    }
  }
  return json;
}

Json json_of(const Check& check) {
  return {{"check", check.name},
          {"value", std::isfinite(check.value) ? Json(check.value) : Json(nullptr)},
          {"bound", check.bound},
          {"passed", check.passed}};
}

std::string mode_name(const PilOptions& options) { return std::string(name_of(options.mode)); }

Result<Provenance> provenance_of(const PilOptions& options) {
  Provenance provenance;
  provenance.command = "pil";
  const bool by_table = options.emit.resistance == ResistanceForm::kTable;
  provenance.options = {{"mode", mode_name(options)},
                        {"link", options.link == cli::PilLink::kMemory ? "memory" : "uart"},
                        {"resistance", by_table ? "table" : "powf"},
                        {"table-error", fmt::format("{:g}", options.emit.table_error)}};
  for (const fs::path& path : {options.model, options.gains, options.scenario}) {
    const auto input = input_file(path);
    if (!input) return tl::unexpected(input.error());
    provenance.inputs.push_back(*input);
  }
  return provenance;
}

Result<std::string> text_of(const PilOptions& options, const Inputs& in, const Report& report) {
  Json json;
  json["schema"] = "awmr.pil/1";
  const auto provenance = provenance_of(options);
  if (!provenance) return tl::unexpected(provenance.error());
  put_provenance(json, *provenance);
  json["scenario"] = in.setup.scenario.name;
  json["mode"] = mode_name(options);
  json["samples"] = report.chip.rows.size();
  json["difference"] = json_of(report.from_float);
  if (report.from_double) json["difference_double"] = json_of(*report.from_double);
  if (report.by_float32) json["effect"]["float32"] = json_of(*report.by_float32);
  if (report.by_table) json["effect"]["table"] = json_of(*report.by_table);
  json["cycles"] = {
      {"min", report.cycles.min}, {"mean", report.cycles.mean}, {"max", report.cycles.max}};
  json["period_share"] = report.cycles.max / (in.setup.sample_time_s * kClockHz);
  json["flash_bytes"] = report.chip.figures.flash_bytes;
  json["ram_bytes"] = report.chip.figures.ram_bytes;
  const auto& stack = report.chip.figures.stack_bytes;
  json["stack_bytes"] = stack ? Json(*stack) : Json(nullptr);
  if (const auto& injected = report.injected) {
    json["injected"] = {{"expected_fault", injected->expected},
                        {"fault", injected->seen},
                        {"start_fault", report.chip.start_fault},
                        {"safe", injected->safe}};
  }
  json["checks"] = Json::array();
  for (const Check& check : report.checks) json["checks"].push_back(json_of(check));
  json["verdict"] = report.passed() ? "passed" : "failed";
  return to_text(json);
}

std::string summary_of(const PilOptions& options, const Inputs& in, const Report& report) {
  const ChipFigures& figures = report.chip.figures;
  std::string text = fmt::format(
      "{}, {}, {} samples on an ATmega2560 at 16 MHz\n"
      "  cycles per step: min {}, mean {:.0f}, max {} ({:.1f} % of the sample time)\n"
      "  flash {} bytes, RAM {} bytes, stack {}; {:.0f} times real time\n",
      in.setup.scenario.name, mode_name(options), report.chip.rows.size(), report.cycles.min,
      report.cycles.mean, report.cycles.max,
      100.0 * report.cycles.max / (in.setup.sample_time_s * kClockHz), figures.flash_bytes,
      figures.ram_bytes,
      figures.stack_bytes ? fmt::format("{} bytes", *figures.stack_bytes) : "unknown",
      report.chip.real_time_factor);
  for (const Check& check : report.checks) {
    text += fmt::format("  {}: {} {:.3g}, at most {:.6g}{}{}\n", check.passed ? "passed" : "FAILED",
                        check.name, check.value, check.bound, check.unit.empty() ? "" : " ",
                        check.unit);
  }
  return text + fmt::format("wrote {}\n", options.output.string());
}

}  // namespace

Result<Outcome> run_pil(const PilOptions& options) {
  const auto in = read_inputs(options);
  if (!in) return tl::unexpected(in.error());
  Report report;
  auto chip = run_chip(options, *in);
  if (!chip) return tl::unexpected(chip.error());
  report.chip = std::move(*chip);
  report.cycles = cycles_of(report.chip.rows);
  if (auto compared = compare_runs(options, *in, report); !compared) {
    return tl::unexpected(compared.error());
  }
  judge(options, report);
  const auto text = text_of(options, *in, report);
  if (!text) return tl::unexpected(text.error());
  if (auto written = write_file(options.output, *text); !written) {
    return tl::unexpected(written.error());
  }
  return Outcome{summary_of(options, *in, report), report.passed()};
}

}  // namespace awmr::pil
