#include "awmr/emit/emit.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "commands.h"
#include "emit_options.h"

namespace awmr::cli {
namespace {

/// `DIR/PATH` for each file, directories made as needed.
Status write_files(const fs::path& directory, const std::vector<EmittedFile>& files) {
  for (const EmittedFile& file : files) {
    const fs::path path = directory / file.path;
    if (auto made = make_directory(path.parent_path()); !made) return made;
    if (auto written = write_file(path, file.bytes); !written) return written;
  }
  return {};
}

std::string table_line(const char* name, const EmittedTable& table) {
  return fmt::format(
      "  {} table: {} values up to {:g}, worst error {:.1e} below {:g}, {:.1e} of it "
      "above\n",
      name, table.values.size(), table.top_speed, table.worst_error, table.split,
      table.worst_relative_error);
}

}  // namespace

Result<Outcome> execute(const EmitCommand& command) {
  const auto model = read_model(command.model);
  if (!model) return tl::unexpected(model.error());
  const auto gains = read_gains(command.gains);
  if (!gains) return tl::unexpected(gains.error());
  const auto inputs = emit_inputs(command.model, command.gains);
  if (!inputs) return tl::unexpected(inputs.error());

  std::vector<EmittedFile> files;
  std::string summary;
  if (command.header_only) {
    const auto header = params_header(*model, *gains, *inputs);
    if (!header) return tl::unexpected(header.error());
    files.push_back({"awmr_params.h", *header});
  } else {
    auto library = firmware_library(*model, *gains, *inputs, command.emit);
    if (!library) return tl::unexpected(library.error());
    files = std::move(*library);
    if (command.emit.resistance == ResistanceForm::kTable) {
      const auto parameters = autopilot_parameters(*model, *gains, *inputs, command.emit);
      if (!parameters) return tl::unexpected(parameters.error());
      summary += table_line("surge", parameters->surge) + table_line("yaw", parameters->yaw);
    }
  }
  if (const auto made = make_directory(command.output); !made) return tl::unexpected(made.error());
  if (const auto written = write_files(command.output, files); !written) {
    return tl::unexpected(written.error());
  }
  summary = fmt::format("wrote {}{}\n{}", (command.output / "awmr_params.h").string(),
                        command.header_only ? "" : " and the Arduino library around it", summary);
  return Outcome{.summary = summary};
}

void add_emit(CLI::App& app, Session& session) {
  auto command = std::make_shared<EmitCommand>();
  CLI::App* sub =
      add_command(app, session, "emit", "Write awmr_params.h and the Arduino library around it",
                  "awmr emit --model model.json --gains gains.json -o firmware",
                  [command] { return execute(*command); });
  sub->add_option("--model", command->model, "model.json from identify")->required();
  sub->add_option("--gains", command->gains, "gains.json from tune")->required();
  sub->add_flag("--header-only", command->header_only, "awmr_params.h alone, without the library");
  add_emit_options(*sub, command->emit);
  add_output(*sub, command->output, "Directory for awmr_params.h and the library");
}

}  // namespace awmr::cli
