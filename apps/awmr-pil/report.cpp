#include "report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "awmr/core/input_file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/name_table.h"
#include "awmr/emit/emit.h"
#include "emulator.h"
#include "injections.h"

namespace awmr::pil {
namespace {

namespace fs = std::filesystem;
using cli::Injection;
using cli::PilOptions;

Check at_most(std::string name, double value, double bound, std::string unit) {
  return {std::move(name), value, bound, value <= bound, std::move(unit)};
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

std::string parts_text(const EmitOptions& options) {
  std::vector<std::string_view> names;
  for (const FirmwarePart part : options.parts) names.push_back(name_in(kFirmwarePartNames, part));
  return fmt::format("{}", fmt::join(names, ","));
}

std::string mode_name(const PilOptions& options) { return std::string(name_of(options.mode)); }

Result<Provenance> provenance_of(const PilOptions& options) {
  Provenance provenance;
  provenance.command = "pil";
  provenance.options = {
      {"mode", mode_name(options)},
      {"link", std::string(name_in(cli::kPilLinkNames, options.link))},
      {"resistance", std::string(name_in(kResistanceFormNames, options.emit.resistance))},
      {"with", parts_text(options.emit)},
      {"split", std::string(name_in(kCombinedSplitNames, options.emit.split))},
      {"optimize", std::string(name_in(cli::kOptimizeNames, *options.optimize))},
      {"table-error", fmt::format("{:g}", options.emit.table_error.value_or(kTableError))},
      {"inject", std::string(name_in(cli::kInjectionNames, options.injection))},
      {"line-noise", fmt::format("{:g}", options.line_noise)},
      {"hostile-steps", std::to_string(options.hostile_steps)}};
  for (const fs::path& path : {options.model, options.gains, options.scenario}) {
    const auto input = input_file(path);
    if (!input) return tl::unexpected(input.error());
    provenance.inputs.push_back(*input);
  }
  return provenance;
}

bool is_safe(const Allocation<float>& command) {
  return std::max({std::abs(command.force.left), std::abs(command.force.right),
                   std::abs(command.steering_rad)}) <= 0.0F;
}

/// Evaluates a failure that must disarm the vehicle. The autopilot's first fault must come in time
/// and with the right cause. From this fault to the end, the command must be safe.
Injected disarming_of(const LoopSetup& setup, const std::vector<LoopRow>& rows) {
  Injected result;
  result.expected = effect_of(setup.injection).fault;
  const auto has_fault = [](const LoopRow& row) { return row.step.output.fault != kFaultNone; };
  const auto first = std::find_if(rows.begin(), rows.end(), has_fault);
  if (first == rows.end()) return result;
  const auto at = static_cast<std::size_t>(first - rows.begin());
  result.seen = first->step.output.fault;
  result.quiet = at >= setup.middle;
  result.worked = (result.seen & result.expected) != 0 &&
                  is_expected_cause(setup.injection, first->cause) &&
                  static_cast<double>(at - std::min(at, setup.middle)) * setup.sample_time_s <=
                      effect_of(setup.injection).within_s;
  result.safe = std::all_of(first, rows.end(), [&](const LoopRow& row) {
    return has_fault(row) && is_safe(row.step.output.command);
  });
  return result;
}

}  // namespace

std::vector<std::size_t> restarts_of(const std::vector<LoopRow>& rows) {
  std::vector<std::size_t> restarts;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows[k].step.restarted) restarts.push_back(k);
  }
  return restarts;
}

Injected injected_of(const LoopSetup& setup, const std::vector<LoopRow>& rows) {
  Injected result;
  result.expected = effect_of(setup.injection).fault;
  if (disarms(setup.injection)) return disarming_of(setup, rows);
  const Window window = injection_window(setup.injection, setup.middle, rows.size());
  result.seen = window.first < window.last ? 0xFF : 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const AutopilotOutput& out = rows[i].step.output;
    if (i < window.first || i >= window.last) {
      result.quiet = result.quiet && out.fault == kFaultNone;
      continue;
    }
    result.seen &= out.fault;
    result.safe = result.safe && is_safe(out.command);
  }
  result.worked = setup.injection == Injection::kReset ? restarts_of(rows) == setup.resets
                                                       : (result.seen & result.expected) != 0;
  return result;
}

void evaluate(const PilOptions& options, double period_cycles, Report& report) {
  const bool by_table = options.emit.resistance == ResistanceForm::kTable;
  const ChipFigures& figures = report.chip.figures;
  std::vector<Check>& checks = report.checks;
  checks.push_back(at_most("cycles", report.cycles.max, *options.cycles_max, "cycles"));
  if (const auto& hostile = report.chip.hostile) {
    checks.push_back(
        at_most("cycles from hostile inputs", hostile->cycles, period_cycles, "cycles"));
    if (by_table) {
      checks.push_back(at_most("differences from the host on hostile inputs",
                               static_cast<double>(hostile->differing), 0.0, ""));
    }
  }
  checks.push_back(at_most("flash", figures.flash_bytes, options.flash_max, "bytes"));
  checks.push_back(at_most("ram", figures.ram_bytes, options.ram_max, "bytes"));
  checks.push_back(at_most("difference from the host's float run", report.from_float.largest(),
                           options.difference_max.value_or(by_table ? 0.0 : 1e-6), ""));
  checks.push_back({"row count unlike the host's float run",
                    report.from_float.same_length ? 0.0 : 1.0, 0.0, report.from_float.same_length,
                    ""});
  if (report.from_double) {
    checks.push_back(at_most("heading difference from the host's double run, within one sample",
                             report.heading_apart_deg, *options.heading_max_deg, "deg"));
  }
  if (const auto& injected = report.injected) {
    const bool reset = options.injection == Injection::kReset;
    checks.push_back({reset ? "no restart after the reset" : "injected fault not raised",
                      injected->worked ? 0.0 : 1.0, 0.0, injected->worked, ""});
    checks.push_back({"no safe command", injected->safe ? 0.0 : 1.0, 0.0, injected->safe, ""});
    checks.push_back({"other faults", injected->quiet ? 0.0 : 1.0, 0.0, injected->quiet, ""});
  } else {
    const bool clean = report.chip.start_fault == kFaultNone &&
                       std::all_of(report.chip.rows.begin(), report.chip.rows.end(),
                                   [](const LoopRow& row) { return row.step.output.fault == 0; });
    checks.push_back({"faults", clean ? 0.0 : 1.0, 0.0, clean, ""});
  }
}

Result<std::string> report_text(const PilOptions& options, const LoopSetup& setup,
                                const Report& report) {
  AWMR_ASSIGN_OR_RETURN(const Provenance provenance, provenance_of(options));
  Json json = output_document("awmr.pil/1", provenance);
  json["scenario"] = setup.scenario.name;
  json["mode"] = mode_name(options);
  json["samples"] = report.chip.rows.size();
  json["difference"] = json_of(report.from_float);
  if (report.from_double) json["difference_double"] = json_of(*report.from_double);
  if (report.by_float32) json["effect"]["float32"] = json_of(*report.by_float32);
  if (report.by_table) json["effect"]["table"] = json_of(*report.by_table);
  json["guidance_on_chip"] = setup.mission.leads();
  json["cycles"] = {
      {"min", report.cycles.min}, {"mean", report.cycles.mean}, {"max", report.cycles.max}};
  const auto& hostile = report.chip.hostile;
  json["cycles_bound"] =
      hostile ? Json(std::max(hostile->cycles, report.cycles.max)) : Json(nullptr);
  if (hostile) json["hostile"] = {{"steps", hostile->steps}, {"differing", hostile->differing}};
  json["period_share"] = report.cycles.max / (setup.sample_time_s * kChipClock_Hz);
  json["flash_bytes"] = report.chip.figures.flash_bytes;
  json["ram_bytes"] = report.chip.figures.ram_bytes;
  if (const auto& repeats = report.chip.figures.repeats) json["repeats"] = *repeats;
  json["restarts"] = report.restarts.size();
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

std::string report_summary(const PilOptions& options, const LoopSetup& setup,
                           const Report& report) {
  const ChipFigures& figures = report.chip.figures;
  std::string text = fmt::format(
      "{}, {}, {} samples on an ATmega2560 at 16 MHz\n"
      "  cycles per step: min {}, mean {:.0f}, max {} ({:.1f} % of the sample time)\n"
      "  flash {} bytes, RAM {} bytes, stack {}; {:.0f} times real time\n",
      setup.scenario.name, mode_name(options), report.chip.rows.size(), report.cycles.min,
      report.cycles.mean, report.cycles.max,
      100.0 * report.cycles.max / (setup.sample_time_s * kChipClock_Hz), figures.flash_bytes,
      figures.ram_bytes,
      figures.stack_bytes ? fmt::format("{} bytes", *figures.stack_bytes) : "unknown",
      report.chip.real_time_factor);
  if (figures.repeats) text += fmt::format("  {} requests sent again\n", *figures.repeats);
  if (!report.restarts.empty()) {
    text += fmt::format("  reset during the run and restarted: {} times\n", report.restarts.size());
  }
  if (const auto& hostile = report.chip.hostile) {
    text +=
        fmt::format("  {} steps with hostile inputs: at most {} cycles, {} differ from the host\n",
                    hostile->steps, hostile->cycles, hostile->differing);
  }
  for (const Check& check : report.checks) {
    text += fmt::format("  {}: {} {:.3g}, at most {:.6g}{}{}\n", check.passed ? "passed" : "FAILED",
                        check.name, check.value, check.bound, check.unit.empty() ? "" : " ",
                        check.unit);
  }
  return text + fmt::format("wrote {}\n", options.output.string());
}

}  // namespace awmr::pil
