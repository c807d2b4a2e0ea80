#include "awmr/report/report.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "commands.h"

namespace awmr::cli {

Result<Outcome> execute(const ReportCommand& command) {
  const auto html = report_html(command.directory);
  if (!html) return tl::unexpected(html.error());
  const fs::path path = command.directory / "report.html";
  if (const auto written = write_file(path, *html); !written) {
    return tl::unexpected(written.error());
  }
  return Outcome{.summary = fmt::format("wrote {}\n", path.string())};
}

void add_report(CLI::App& app, Session& session) {
  auto command = std::make_shared<ReportCommand>();
  CLI::App* sub = add_command(app, session, "report", "Make report.html from a results directory",
                              "awmr report out", [command] { return execute(*command); });
  sub->add_option("DIR", command->directory, "Directory that `awmr run` filled")->required();
}

}  // namespace awmr::cli
