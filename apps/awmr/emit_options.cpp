#include "emit_options.h"

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/input_file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/json/json_document.h"
#include "awmr/core/provenance.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/gains_json.h"
#include "awmr/simulate/scenario.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

void add_resistance_options(CLI::App& command, EmitOptions& options) {
  add_choice(command, "--resistance", options.resistance, kResistanceFormNames,
             "How the chip computes resistances: by an interpolated table in flash, or by the C "
             "library's powf")
      ->default_str("table");
  command
      .add_option("--table-error", options.table_error,
                  "Largest permitted error of a resistance table, as a fraction of the resistance. "
                  "Where the resistance is below a tenth of the largest force (yaw: moment): as a "
                  "fraction of this tenth. If you give a value and no table meets it, emit fails "
                  "[5e-4; if no table meets this, the most accurate table and a warning]")
      ->check(within(1e-7, 0.1));
}

void add_parts_option(CLI::App& command, EmitOptions& options) {
  command
      .add_option_function<std::vector<std::string>>(
          "--with",
          [&options](const std::vector<std::string>& names) {
            for (const std::string& name : names) {
              options.parts.insert(*value_in(kFirmwarePartNames, name));
            }
          },
          "Optional parts to compile in, in addition to heading hold and waypoints")
      ->delimiter(',')
      ->check(one_of(names_in(kFirmwarePartNames)));
}

void add_timeouts(CLI::App& command, EmitOptions& options) {
  constexpr std::uint32_t kHour_ms = 3600000;
  const auto timeout = [&](const char* name, std::uint32_t& value, const char* meaning) {
    command.add_option(name, value, meaning)
        ->check(within<std::uint32_t>(1, kHour_ms))
        ->capture_default_str();
  };
  timeout("--heading-timeout-ms", options.heading_timeout_ms,
          "Largest permitted age of heading and yaw rate, ms; older readings raise a fault, which "
          "stops the motors");
  timeout("--speed-timeout-ms", options.speed_timeout_ms,
          "Largest permitted age of speed and position, ms; older readings raise a fault, which "
          "stops the motors");
  timeout("--command-timeout-ms", options.command_timeout_ms,
          "Largest permitted time between two commands, ms; a longer pause raises a fault, which "
          "stops the motors");
  command
      .add_option(
          "--step-timeout-ms", options.step_timeout_ms,
          "Largest permitted time between two steps, ms; a longer time raises a fault, which "
          "stops the motors [three sample times]")
      ->check(within<std::uint32_t>(1, kHour_ms));
}

}  // namespace

void add_emit_options(CLI::App& command, EmitOptions& options) {
  add_resistance_options(command, options);
  add_parts_option(command, options);
  add_choice(command, "--split", options.split, kCombinedSplitNames,
             "Split of the yaw moment in combined mode: steering makes one half, different wheel "
             "forces the other. If one of the two reaches its limit: redistribute lets the other "
             "one make the missing moment; fixed_half omits it")
      ->default_str("redistribute");
  add_timeouts(command, options);
}

Result<EmitInputs> emit_inputs(const std::filesystem::path& model,
                               const std::filesystem::path& gains) {
  AWMR_ASSIGN_OR_RETURN(const InputFile model_input, input_file(model));
  AWMR_ASSIGN_OR_RETURN(const InputFile gains_input, input_file(gains));
  AWMR_ASSIGN_OR_RETURN(const Json gains_json, read_json_file(gains));
  EmitInputs inputs{
      .model_sha256 = model_input.sha256,
      .gains_sha256 = gains_input.sha256,
      .gains_file = gains.filename().string(),
      .has_gains_of_another_model = !is_made_from(gains_json, model_input.sha256).value_or(true)};
  inputs.has_changed_gains = has_changed_gains(gains_json);
  if (inputs.has_gains_of_another_model || inputs.has_changed_gains) return inputs;
  AWMR_ASSIGN_OR_RETURN(inputs.certificate, read_certificate(gains));
  return inputs;
}

}  // namespace awmr::cli
