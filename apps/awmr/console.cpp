#include "console.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <utility>

#include "awmr/core/option_text.h"

namespace awmr::cli {
namespace {

void print(std::FILE* stream, const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stream);
}

int report(const Result<Outcome>& result, bool quiet) {
  if (!result) {
    print(stderr, spell_options(awmr::to_text(result.error()), "--"));
    return exit_code(result.error());
  }
  for (const Finding& finding : result->findings) {
    const bool matters = result->refused && finding.severity == Severity::kError;
    if (!quiet || matters) print(stderr, to_text(finding) + "\n");
  }
  if (!quiet) print(stdout, result->summary);
  return result->refused ? 1 : 0;
}

std::string origin(const Estimate& estimate) {
  const char* source = estimate.source == Source::kGiven     ? "given"
                       : estimate.source == Source::kDerived ? "derived"
                                                             : "fitted";
  return fmt::format("{}, {}", source, estimate.method);
}

}  // namespace

CLI::App* add_command(CLI::App& app, Session& session, const std::string& name,
                      const std::string& description, const std::string& example,
                      std::function<Result<Outcome>()> execute) {
  CLI::App* command = app.add_subcommand(name, description);
  command->footer("Example:\n  " + example);
  command->set_version_flag("--version", std::string("awmr ") + version());
  auto quiet = std::make_shared<bool>(false);
  command->add_flag("--quiet", *quiet, "Print errors only");
  command->callback([&session, quiet, execute = std::move(execute)] {
    session.exit_code = report(execute(), *quiet);
  });
  return command;
}

CLI::Option* add_output(CLI::App& command, std::filesystem::path& path,
                        const std::string& meaning) {
  return command.add_option("-o,--output", path, meaning)->required();
}

std::string to_text(const Finding& finding) {
  const char* severity = finding.severity == Severity::kNote      ? "note"
                         : finding.severity == Severity::kWarning ? "warning"
                                                                  : "error";
  std::string place;
  if (!finding.file.empty()) place = finding.file + ":";
  if (finding.line > 0) place += fmt::format("{}:", finding.line);
  if (!place.empty()) place += " ";
  return fmt::format("{}: {}{} [{}]", severity, place, spell_options(finding.message, "--"),
                     finding.code);
}

std::string parameter_table_text(const Model& model) {
  std::string text = fmt::format("  {:<24} {:>10} {:>10}  {:<24} {:<12} {}\n", "", "value",
                                 "std error", "95 % interval", "unit", "origin");
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    if (parameter.term && estimate.source == Source::kGiven && estimate.value == 0.0) continue;
    const std::string value =
        estimate.value ? fmt::format("{:.5g}", *estimate.value) : std::string("unknown");
    const std::string error =
        estimate.std_error ? fmt::format("{:.2g}", *estimate.std_error) : std::string("-");
    const std::string interval =
        estimate.ci95 ? fmt::format("[{:.4g}, {:.4g}]", estimate.ci95->lo, estimate.ci95->hi)
                      : std::string("-");
    text += fmt::format("  {:<24} {:>10} {:>10}  {:<24} {:<12} {}\n", parameter.name, value, error,
                        interval, parameter.unit, origin(estimate));
  }
  return text;
}

}  // namespace awmr::cli
