/// Firmware options, shared by `emit` and `pil`.
#pragma once

#include <filesystem>

#include "awmr/core/result.h"
#include "awmr/emit/emit.h"

namespace CLI {
class App;
}  // namespace CLI

namespace awmr::cli {

/// Adds `--resistance`, `--table-error`, `--with`, `--split` and the four `--...-timeout-ms`.
void add_emit_options(CLI::App& command, EmitOptions& options);

/// Returns the origin of the firmware's parameters: the hashes of model and gains file, the name of
/// the gains file, and the robustness certificate in it. Errors: those of input_file() and
/// read_certificate().
Result<EmitInputs> emit_inputs(const std::filesystem::path& model,
                               const std::filesystem::path& gains);

}  // namespace awmr::cli
