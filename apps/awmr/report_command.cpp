#include "awmr/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "awmr/core/file.h"
#include "commands.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

/// Writes the data of all figures; if a file cannot be written, writes none. A figure without data
/// is no error, and a note names it. An existing plot.py is kept, because the user may have edited
/// it.
Status write_figures(FigureSet figures, const fs::path& directory, Outcome& outcome) {
  AWMR_RETURN_IF_ERROR(make_directory(directory));
  const fs::path plot = directory / kPlotName;
  std::error_code unreadable;
  const bool is_kept = fs::exists(plot, unreadable);
  if (is_kept) {
    std::erase_if(figures.files, [](const OutputFile& f) { return f.path == kPlotName; });
  }
  for (OutputFile& file : figures.files) {
    file.path = directory / file.path;
    outcome.written.push_back(file.path);
  }
  AWMR_RETURN_IF_ERROR(write_files(figures.files));
  outcome.summary += fmt::format(
      "wrote the data of {} figures to {}; python3 {}{} draws each as SVG and PDF:\n  {}\n",
      figures.names.size(), directory.string(), plot.string(),
      is_kept ? ", which is kept as it was," : "", fmt::join(figures.names, "\n  "));
  for (const std::string& lacking : figures.lacking) {
    outcome.findings.push_back({"", 0, Severity::kNote, "not-drawn", lacking});
  }
  return {};
}

}  // namespace

Result<Outcome> execute(const ReportCommand& command) {
  AWMR_RETURN_IF_ERROR(check_regular_file(command.directory / "report.html"));
  AWMR_ASSIGN_OR_RETURN(ReportPage page, report_page(command.directory));
  const fs::path path = command.directory / "report.html";
  Outcome outcome{.summary = fmt::format("wrote {}\n", path.string()),
                  .findings = std::move(page.left_out),
                  .written = {path}};
  if (command.figures) {
    AWMR_ASSIGN_OR_RETURN(FigureSet figures, report_figures(command.directory));
    AWMR_RETURN_IF_ERROR(write_figures(std::move(figures), *command.figures, outcome));
  }
  AWMR_RETURN_IF_ERROR(write_file(path, page.html));
  return outcome;
}

void add_report(CLI::App& app, Session& session) {
  auto command = std::make_shared<ReportCommand>();
  CLI::App* sub = add_command(
      app, session, "report", "Make report.html from a results directory, and figures for print",
      "awmr report out --figures figures", [command] { return execute(*command); });
  add_directory(*sub, "DIR", command->directory, "Directory that `awmr run` filled")->required();
  add_directory(
      *sub, "--figures", command->figures,
      "Also write all figures to this directory: one CSV per figure, and plot.py, which draws "
      "them as SVG and PDF by matplotlib");
}

}  // namespace awmr::cli
