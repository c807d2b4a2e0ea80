#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/core/input_file.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "commands.h"

namespace awmr::cli {
namespace {

/// The verdict, and the claims by what became of them.
std::string brief_of(const Validation& validation) {
  std::vector<std::string> reproduced;
  std::vector<std::string> others;
  for (const Claim& claim : validation.claims) {
    (claim.reproduced ? reproduced : others).push_back(claim.id);
  }
  return fmt::format("  {}\n  claims reproduced: {}; not reproduced: {}\n", validation.verdict,
                     fmt::join(reproduced, " "),
                     others.empty() ? "none" : fmt::format("{}", fmt::join(others, " ")));
}

Result<std::vector<LogValidation>> validate_logs(const ValidateCommand& command,
                                                 const Plant<double>& plant,
                                                 std::vector<Finding>& findings) {
  std::vector<LogValidation> validations;
  std::vector<Fault> faults;
  for (const fs::path& path : command.logs) {
    const auto log = read_log(path, command.trials, findings);
    if (log) {
      validations.push_back(validate_log(*log, plant, command.horizon_s, command.log_tolerance));
    } else {
      faults.insert(faults.end(), log.error().faults.begin(), log.error().faults.end());
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return validations;
}

}  // namespace

Result<Outcome> execute(const ValidateCommand& command) {
  const auto model = read_model(command.model);
  if (!model) return tl::unexpected(model.error());
  std::optional<Gains<double>> gains;
  if (command.gains) {
    const auto read = read_gains(*command.gains);
    if (!read) return tl::unexpected(read.error());
    gains = *read;
  } else if (command.claims) {
    gains = kPaperGains;
  }
  Provenance provenance{"validate", {{"tolerance", format_number(command.validate.tolerance)}}, {}};
  std::vector<fs::path> inputs{command.model};
  if (command.gains) inputs.push_back(*command.gains);
  inputs.insert(inputs.end(), command.logs.begin(), command.logs.end());
  for (const fs::path& path : inputs) {
    const auto input = input_file(path);
    if (!input) return tl::unexpected(input.error());
    provenance.inputs.push_back(*input);
  }
  auto validation = validate(*model, gains, command.validate);
  if (!validation) return tl::unexpected(validation.error());
  std::vector<Finding> findings;
  auto logs = validate_logs(command, *model->plant(), findings);
  if (!logs) return tl::unexpected(logs.error());
  add_logs(*validation, std::move(*logs), command.log_tolerance);
  if (const auto written = write_file(command.output, validation_text(*validation, provenance));
      !written) {
    return tl::unexpected(written.error());
  }
  if (command.claims_table) {
    const auto table = write_file(*command.claims_table, claims_markdown(validation->claims));
    if (!table) return tl::unexpected(table.error());
  }
  return Outcome{
      .summary = (command.claims ? claims_table(validation->claims) + validation->verdict + '\n'
                                 : validation_table(*validation)) +
                 fmt::format("wrote {}\n", command.output.string()),
      .brief = brief_of(*validation),
      .findings = std::move(findings),
      .refused = !validation->passed};
}

void add_validate(CLI::App& app, Session& session) {
  auto command = std::make_shared<ValidateCommand>();
  auto columns = std::make_shared<std::vector<std::string>>();
  CLI::App* sub = add_command(
      app, session, "validate", "Hold the model against its trials and the paper's claims",
      "awmr validate --model model.json --gains gains.json -o validation.json",
      [command, columns]() -> Result<Outcome> {
        for (const std::string& text : *columns) {
          auto mapping = parse_column_mapping(text);
          if (!mapping) return tl::unexpected(mapping.error());
          command->trials.columns.push_back(*mapping);
        }
        return execute(*command);
      });
  sub->add_option("--model", command->model, "model.json from identify")->required();
  sub->add_option("--gains", command->gains, "gains.json: also run the closed-loop claims");
  sub->add_option("--tolerance", command->validate.tolerance,
                  "Largest accepted RMS relative error of a kind of trial (default 0.15)")
      ->check(CLI::PositiveNumber);
  sub->add_option(
      "--log", command->logs,
      "CSV of a driving log, best one that the model was not fitted to; may be repeated");
  sub->add_option("--horizon", command->horizon_s,
                  "Length of the windows that a log is predicted over, s (default 10)")
      ->check(CLI::PositiveNumber);
  sub->add_option("--log-tolerance", command->log_tolerance,
                  "Largest accepted NRMSE of a channel over a window (default 0.3)")
      ->check(CLI::PositiveNumber);
  sub->add_option("--column", *columns, "NAME=SOURCE[*SCALE][+OFFSET]: another column's name");
  auto* claims = sub->add_flag("--claims", command->claims,
                               "Tell of each of the paper's fourteen claims what was found, what "
                               "counts and why; without --gains, with the paper's gains");
  sub->add_option("--claims-table", command->claims_table,
                  "Also write the claims as a Markdown table")
      ->needs(claims);
  add_output(*sub, command->output, "validation.json to write");
}

}  // namespace awmr::cli
