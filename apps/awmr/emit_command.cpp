#include "awmr/emit/emit.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/model/gains_file.h"
#include "commands.h"

namespace awmr::cli {

Result<Outcome> execute(const EmitCommand& command) {
  const auto model = read_model(command.model);
  if (!model) return tl::unexpected(model.error());
  const auto gains = read_gains(command.gains);
  if (!gains) return tl::unexpected(gains.error());
  const auto model_input = input_file(command.model);
  if (!model_input) return tl::unexpected(model_input.error());
  const auto gains_input = input_file(command.gains);
  if (!gains_input) return tl::unexpected(gains_input.error());
  const auto header = params_header(*model, *gains,
                                    {command.model.filename().string(), model_input->sha256,
                                     gains_input->sha256, command.gains.filename().string()});
  if (!header) return tl::unexpected(header.error());
  if (const auto made = make_directory(command.output); !made) return tl::unexpected(made.error());
  const fs::path path = command.output / "awmr_params.h";
  if (const auto written = write_file(path, *header); !written) {
    return tl::unexpected(written.error());
  }
  return Outcome{.summary = fmt::format("wrote {}\n", path.string())};
}

void add_emit(CLI::App& app, Session& session) {
  auto command = std::make_shared<EmitCommand>();
  CLI::App* sub = add_command(app, session, "emit", "Write awmr_params.h for the AVR",
                              "awmr emit --model model.json --gains gains.json -o firmware",
                              [command] { return execute(*command); });
  sub->add_option("--model", command->model, "model.json from identify")->required();
  sub->add_option("--gains", command->gains, "gains.json from tune")->required();
  add_output(*sub, command->output, "Directory for awmr_params.h");
}

}  // namespace awmr::cli
