/// Firmware options, shared by `emit` and `pil`.
#pragma once

#include <filesystem>

#include "awmr/core/result.h"
#include "awmr/emit/emit.h"

namespace CLI {
class App;
}  // namespace CLI

namespace awmr::cli {

/// Adds `--resistance`, `--table-error`, `--with`, `--split` and the timeouts.
void add_emit_options(CLI::App& command, EmitOptions& options);

/// Returns the names and hashes of the two input files.
Result<EmitInputs> emit_inputs(const std::filesystem::path& model,
                               const std::filesystem::path& gains);

}  // namespace awmr::cli
