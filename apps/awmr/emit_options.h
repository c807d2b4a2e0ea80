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
/// the gains file, and its robustness certificate. Gains that were tuned with another model have no
/// certificate. Errors: those of input_file(), read_json_file() and read_certificate().
Result<EmitInputs> emit_inputs(const std::filesystem::path& model,
                               const std::filesystem::path& gains);

}  // namespace awmr::cli
