#include "console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sstream>
#include <utility>

#include "awmr/core/json/json_document.h"
#include "awmr/core/option_text.h"
#include "awmr/core/text.h"
#include "awmr/model/finding_rank.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/si_units.h"
#include "findings_text.h"
#include "json_output.h"
#include "option_values.h"
#include "progress.h"
#include "style.h"

namespace awmr::cli {
namespace {

/// Returns false if the stream does not accept all bytes, as on a full disk.
bool print(std::FILE* stream, const std::string& text) {
  return std::fwrite(text.data(), 1, text.size(), stream) == text.size() &&
         std::fflush(stream) == 0;
}

/// Options of a command that change its output on the terminal: `--quiet`, `--verbose`, `--json`.
struct Manner {
  bool quiet = false;
  bool verbose = false;
  bool json = false;
};

int to_stdout(const std::string& text, int exit_code) {
  if (print(stdout, text)) return exit_code;
  print(stderr, fmt::format("error: cannot write to standard output: {} [cannot-write]\n",
                            std::strerror(errno)));
  return 2;
}

/// Makes the titles in the summary bold. A line is a title if it is not indented and either has
/// only one word or stands above an indented line.
std::string styled(const std::string& summary, const Style& style) {
  std::istringstream lines(printable_lines(summary));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const bool word = line.find_first_of(" :/") == std::string::npos;
    const bool title = !line.empty() && line.front() != ' ' && (word || lines.peek() == ' ');
    text += (title ? style.bold(line) : line) + "\n";
  }
  return text;
}

/// Prints the findings on stderr: with `--verbose` all of them, with `--quiet` only the errors that
/// explain why a request was refused. Otherwise prints the text of findings_text(), which shortens
/// long lists.
void print_findings(const Outcome& outcome, Manner manner) {
  const Style style(stderr);
  std::string text;
  if (!manner.quiet && !manner.verbose) text = findings_text(outcome.findings, style);
  for (const Finding* finding : by_effect(outcome.findings)) {
    const bool matters = outcome.refused && finding->severity == Severity::kError;
    if (manner.quiet ? matters : manner.verbose) text += to_text(*finding, style) + "\n";
  }
  if (!manner.quiet && !text.empty() && ::isatty(::fileno(stderr)) == 1) {
    text += style.faint("awmr explain CODE prints what a finding means and what to do") + "\n";
  }
  print(stderr, text);
}

int report(const std::string& command, const Result<Outcome>& result, Manner manner) {
  if (!result) {
    print(stderr, manner.json ? error_text(result.error()) : awmr::to_text(result.error(), "--"));
    return exit_code(result.error());
  }
  int exit_code = result->refused ? 1 : 0;
  if (manner.json) {
    return to_stdout(
        result_text({command, exit_code, result->written, result->findings, result->document}),
        exit_code);
  }
  // Prints the results first, then the findings.
  const std::string text =
      result->summary + (manner.verbose ? result->details : "") + result->closing;
  if (!manner.quiet) exit_code = to_stdout(styled(text, Style(stdout)), exit_code);
  print_findings(*result, manner);
  return exit_code;
}

/// Executes the command. Shows the command's name as progress until the command reports its own
/// progress. `live` is an exception, because it has its own screen.
Result<Outcome> watched(const std::string& name, const std::function<Result<Outcome>()>& execute) {
  if (name == "live") return execute();
  const Working working("awmr " + name);
  return execute();
}

std::string origin(const Estimate& estimate) {
  return fmt::format("{}, {}", name_in(kSourceNames, estimate.source), estimate.method);
}

/// Formats a standard error with two significant digits: 0.0099, 160.
std::string two_digits(double error) {
  if (!(error > 0.0)) return fmt::format("{:g}", error);
  const double digit = std::pow(10.0, std::floor(std::log10(error)) - 1.0);
  return fmt::format("{:.6g}", std::round(error / digit) * digit);
}

std::string table_row(std::string_view name, const Estimate& estimate, std::string_view unit) {
  const std::string value =
      estimate.value ? fmt::format("{:.5g}", *estimate.value) : std::string("unknown");
  const std::string error = estimate.std_error ? two_digits(*estimate.std_error) : std::string("-");
  const std::string interval =
      estimate.ci95 ? fmt::format("[{:.4g}, {:.4g}]", estimate.ci95->lo, estimate.ci95->hi)
                    : std::string("-");
  return fmt::format("  {:<24} {:>10} {:>10}  {:<24} {:<14} {}\n", name, value, error, interval,
                     unit, origin(estimate));
}

}  // namespace

CLI::App* add_command(CLI::App& app, Session& session, const std::string& name,
                      const std::string& description, const std::string& example,
                      std::function<Result<Outcome>()> execute) {
  CLI::App* command = app.add_subcommand(name, description);
  const bool needs_files = example.find("configs/") != std::string::npos ||
                           example.find("datasets/") != std::string::npos;
  command->footer(
      "Example:\n  " + example +
      (needs_files ? "\n`awmr init --example .` writes the files of the examples." : ""));
  command->set_version_flag("--version", std::string("awmr ") + version());
  auto manner = std::make_shared<Manner>();
  auto* quiet = command->add_flag("--quiet", manner->quiet, "Print errors only");
  command
      ->add_flag("--verbose", manner->verbose, "Print every finding, and the details of the result")
      ->excludes(quiet);
  command
      ->add_flag("--json", manner->json,
                 "Print the result and its findings as one JSON object on stdout; print errors as "
                 "one JSON object on stderr")
      ->excludes(quiet);
  command->callback([&session, name, manner, execute = std::move(execute)] {
    show_progress({.on_terminal = !manner->quiet, .in_lines = !manner->quiet && !manner->json});
    session.exit_code = report(name, watched(name, execute), *manner);
  });
  return command;
}

CLI::Option* add_output(CLI::App& command, std::filesystem::path& path,
                        const std::string& meaning) {
  return add_file(command, "-o,--output", path, meaning)->required()->check(not_standard_output());
}

CLI::Option* add_output_directory(CLI::App& command, std::filesystem::path& path,
                                  const std::string& meaning) {
  return add_directory(command, "-o,--output", path, meaning)
      ->required()
      ->check(not_standard_output());
}

void put_findings_into_document(Outcome& outcome) {
  outcome.document = with_findings(outcome.document, outcome.findings);
}

Status write_document(const std::optional<std::filesystem::path>& path, Outcome& outcome) {
  put_findings_into_document(outcome);
  if (!path) return {};
  AWMR_RETURN_IF_ERROR(write_file(*path, outcome.document, check_json_text));
  outcome.summary += fmt::format("wrote {}\n", path->string());
  outcome.written = {*path};
  return {};
}

Status check_outputs(const std::filesystem::path& directory, const std::vector<std::string>& names,
                     std::span<const std::filesystem::path> inputs) {
  AWMR_ASSIGN_OR_RETURN(const bool exists, path_exists(directory));
  if (!exists) return check_output_directory(directory);
  for (const std::string& name : names) {
    AWMR_RETURN_IF_ERROR(check_regular_file(directory / name));
    AWMR_RETURN_IF_ERROR(check_output(directory / name, inputs));
  }
  return {};
}

std::string parameter_table_text(const Model& model) {
  std::string text = fmt::format("  {:<24} {:>10} {:>10}  {:<24} {:<14} {}\n", "", "value",
                                 "std error", "95 % interval", "unit", "origin");
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    if (is_absent_term(model, parameter.id) || !has(model.vehicle, parameter.id)) continue;
    text += table_row(parameter.name, estimate, parameter.unit);
  }
  return text;
}

std::string si_table_text(const Model& model) {
  std::string text;
  for (const SiQuantity& quantity : si_quantities(model)) {
    text += table_row(quantity.name, quantity.estimate, quantity.unit);
  }
  return text.empty() ? text
                      : "  in SI units, with F_max = m/m' (largest force of a wheel):\n" + text;
}

}  // namespace awmr::cli
