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

/// `DIR/PATH` for each file, directories made as needed; all or none.
Status write_emitted(const EmitCommand& command, const std::vector<EmittedFile>& files) {
  const fs::path inputs[] = {command.model, command.gains};
  std::vector<OutputFile> outputs;
  for (const EmittedFile& file : files) {
    const fs::path path = command.output / file.path;
    AWMR_RETURN_IF_ERROR(make_directory(path.parent_path()));
    AWMR_RETURN_IF_ERROR(check_output(path, inputs));
    outputs.push_back({path, file.bytes});
  }
  return write_files(outputs);
}

std::string table_line(const char* name, const EmittedTable& table) {
  return fmt::format(
      "  {} table: {} lines up to {:g}, worst error {:.1e} below {:g}, {:.1e} of it "
      "above\n",
      name, table.lines.size(), table.top_speed, table.worst_error, table.split,
      table.worst_relative_error);
}

/// How well the tables of resistance hold; nothing where powf is called instead.
Result<std::string> table_lines(const Model& model, const Gains<double>& gains,
                                const EmitInputs& inputs, const EmitOptions& options) {
  if (options.resistance != ResistanceForm::kTable) return std::string();
  AWMR_ASSIGN_OR_RETURN(const auto parameters, autopilot_parameters(model, gains, inputs, options));
  return table_line("surge", parameters.surge) + table_line("yaw", parameters.yaw);
}

}  // namespace

Result<Outcome> execute(const EmitCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const Model model, read_model(command.model));
  AWMR_ASSIGN_OR_RETURN(const Gains<double> gains, read_gains(command.gains));
  AWMR_ASSIGN_OR_RETURN(const EmitInputs inputs, emit_inputs(command.model, command.gains));
  std::vector<EmittedFile> files;
  std::string tables;
  if (command.header_only) {
    AWMR_ASSIGN_OR_RETURN(std::string header, params_header(model, gains, inputs));
    files.push_back({"awmr_params.h", std::move(header)});
  } else {
    AWMR_ASSIGN_OR_RETURN(files, firmware_library(model, gains, inputs, command.emit));
    AWMR_ASSIGN_OR_RETURN(tables, table_lines(model, gains, inputs, command.emit));
  }
  AWMR_RETURN_IF_ERROR(make_directory(command.output));
  AWMR_RETURN_IF_ERROR(write_emitted(command, files));
  return Outcome{.summary = fmt::format(
                     "wrote {}{}\n{}", (command.output / "awmr_params.h").string(),
                     command.header_only ? "" : " and the Arduino library around it", tables)};
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
