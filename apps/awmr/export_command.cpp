#include "awmr/emit/export.h"

#include <CLI/CLI.hpp>
#include <memory>

#include <fmt/format.h>

#include "awmr/core/file.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "commands.h"
#include "gains_origin.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

struct ExportCommand {
  fs::path model;
  std::optional<fs::path> gains;
  ExportFormat format = ExportFormat::kRos2;
  fs::path output;
};

Result<Outcome> execute(const ExportCommand& command) {
  const std::vector<fs::path> paths = all_paths(command.model, command.gains);
  AWMR_RETURN_IF_ERROR(check_output(command.output, paths));
  AWMR_ASSIGN_OR_RETURN(const Model model, read_model(command.model));
  ExportSource source{.model = model};
  if (command.gains) {
    AWMR_ASSIGN_OR_RETURN(source.gains,
                          read_gains_for(*command.gains, model.vehicle.sample_time_s));
  }
  AWMR_ASSIGN_OR_RETURN(const std::vector<InputFile> inputs, input_files(paths));
  source.inputs = inputs;
  AWMR_ASSIGN_OR_RETURN(const std::string text, export_text(source, command.format));
  AWMR_RETURN_IF_ERROR(write_file(command.output, text));
  AWMR_ASSIGN_OR_RETURN(std::vector<Finding> findings, export_findings(source, command.format));
  if (command.gains) {
    AWMR_RETURN_IF_ERROR(note_other_model(*command.gains, command.model, findings));
  }
  return Outcome{.summary = fmt::format("wrote {}\n", command.output.string()),
                 .findings = std::move(findings),
                 .written = {command.output}};
}

}  // namespace

void add_export(CLI::App& app, Session& session) {
  auto command = std::make_shared<ExportCommand>();
  CLI::App* sub =
      add_command(app, session, "export", "Write model and gains as another program's parameters",
                  "awmr export --model model.json --gains gains.json --format px4 -o rover.params",
                  [command] { return execute(*command); });
  add_file(*sub, "--model", command->model, "model.json from identify")->required();
  add_file(*sub, "--gains", command->gains,
           "gains.json from tune; without it, values derived from gains are left out");
  add_choice(*sub, "--format", command->format, kExportFormatNames,
             "ROS 2 parameters (YAML), MATLAB script, Python module, CSV, or those parameters of "
             "ArduPilot Rover or PX4's rovers that follow from the model, each with its derivation")
      ->required();
  add_output(*sub, command->output, "File to write");
}

}  // namespace awmr::cli
