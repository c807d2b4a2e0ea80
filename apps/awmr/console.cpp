#include "console.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/core/option_text.h"
#include "awmr/core/text.h"
#include "awmr/model/si_units.h"
#include "json_output.h"
#include "paths.h"

namespace awmr::cli {
namespace {

/// False where the stream does not take it all, as on a full disk.
bool print(std::FILE* stream, const std::string& text) {
  return std::fwrite(text.data(), 1, text.size(), stream) == text.size() &&
         std::fflush(stream) == 0;
}

/// How the outcome is told.
struct Manner {
  bool quiet = false;
  bool json = false;
};

int to_stdout(const std::string& text, int exit_code) {
  if (print(stdout, text)) return exit_code;
  print(stderr, fmt::format("error: cannot write to standard output: {}\n", std::strerror(errno)));
  return 2;
}

int report(const std::string& command, const Result<Outcome>& result, Manner manner) {
  if (!result) {
    print(stderr, manner.json ? error_text(result.error()) : awmr::to_text(result.error(), "--"));
    return exit_code(result.error());
  }
  const int exit_code = result->refused ? 1 : 0;
  if (manner.json) {
    return to_stdout(
        result_text({command, exit_code, result->written, result->findings, result->document}),
        exit_code);
  }
  for (const Finding& finding : result->findings) {
    const bool matters = result->refused && finding.severity == Severity::kError;
    if (!manner.quiet || matters) print(stderr, to_text(finding) + "\n");
  }
  return manner.quiet ? exit_code : to_stdout(printable_lines(result->summary), exit_code);
}

std::string origin(const Estimate& estimate) {
  return fmt::format("{}, {}", name_in(kSourceNames, estimate.source), estimate.method);
}

std::string table_row(std::string_view name, const Estimate& estimate, std::string_view unit) {
  const std::string value =
      estimate.value ? fmt::format("{:.5g}", *estimate.value) : std::string("unknown");
  const std::string error =
      estimate.std_error ? fmt::format("{:.2g}", *estimate.std_error) : std::string("-");
  const std::string interval =
      estimate.ci95 ? fmt::format("[{:.4g}, {:.4g}]", estimate.ci95->lo, estimate.ci95->hi)
                    : std::string("-");
  return fmt::format("  {:<24} {:>10} {:>10}  {:<24} {:<12} {}\n", name, value, error, interval,
                     unit, origin(estimate));
}

}  // namespace

CLI::App* add_command(CLI::App& app, Session& session, const std::string& name,
                      const std::string& description, const std::string& example,
                      std::function<Result<Outcome>()> execute) {
  CLI::App* command = app.add_subcommand(name, description);
  command->footer("Example:\n  " + example);
  command->set_version_flag("--version", std::string("awmr ") + version());
  auto manner = std::make_shared<Manner>();
  auto* quiet = command->add_flag("--quiet", manner->quiet, "Print errors only");
  command
      ->add_flag("--json", manner->json,
                 "Print the result and its findings as one JSON object, errors as one on stderr")
      ->excludes(quiet);
  command->callback([&session, name, manner, execute = std::move(execute)] {
    session.exit_code = report(name, execute(), *manner);
  });
  return command;
}

CLI::Option* add_output(CLI::App& command, std::filesystem::path& path,
                        const std::string& meaning) {
  return add_file(command, "-o,--output", path, meaning)->required();
}

CLI::Option* add_output_directory(CLI::App& command, std::filesystem::path& path,
                                  const std::string& meaning) {
  return add_directory(command, "-o,--output", path, meaning)->required();
}

Status write_document(const std::optional<std::filesystem::path>& path, Outcome& outcome) {
  if (!path) return {};
  AWMR_RETURN_IF_ERROR(write_file(*path, outcome.document));
  outcome.summary += fmt::format("wrote {}\n", path->string());
  outcome.written = {*path};
  return {};
}

Status check_outputs(const std::filesystem::path& directory, const std::vector<std::string>& names,
                     std::span<const std::filesystem::path> inputs) {
  if (!std::filesystem::exists(directory)) return {};
  for (const std::string& name : names) {
    AWMR_RETURN_IF_ERROR(check_output(directory / name, inputs));
  }
  return {};
}

std::string to_text(const Finding& finding) {
  const char* severity = finding.severity == Severity::kNote      ? "note"
                         : finding.severity == Severity::kWarning ? "warning"
                                                                  : "error";
  std::string place;
  if (!finding.file.empty()) place = finding.file + ":";
  if (finding.line > 0) place += fmt::format("{}:", finding.line);
  if (!place.empty()) place += " ";
  return fmt::format("{}: {}{} [{}]", severity, printable(shortened(place)),
                     printable(shortened(spell_options(finding.message, "--"))), finding.code);
}

std::string parameter_table_text(const Model& model) {
  std::string text = fmt::format("  {:<24} {:>10} {:>10}  {:<24} {:<12} {}\n", "", "value",
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
  return text.empty() ? text : "  in SI units, with F_max = m/m' of a wheel:\n" + text;
}

}  // namespace awmr::cli
