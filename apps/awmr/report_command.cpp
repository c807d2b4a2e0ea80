#include "awmr/report/report.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "commands.h"
#include "paths.h"

namespace awmr::cli {

Result<Outcome> execute(const ReportCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const std::string html, report_html(command.directory));
  const fs::path path = command.directory / "report.html";
  AWMR_RETURN_IF_ERROR(write_file(path, html));
  return Outcome{.summary = fmt::format("wrote {}\n", path.string()), .written = {path}};
}

void add_report(CLI::App& app, Session& session) {
  auto command = std::make_shared<ReportCommand>();
  CLI::App* sub = add_command(app, session, "report", "Make report.html from a results directory",
                              "awmr report out", [command] { return execute(*command); });
  add_directory(*sub, "DIR", command->directory, "Directory that `awmr run` filled")->required();
}

}  // namespace awmr::cli
