/// The options of the firmware, the same for `emit` and `pil`.
#pragma once

#include <filesystem>

#include "awmr/core/result.h"
#include "awmr/emit/emit.h"

namespace CLI {
class App;
}  // namespace CLI

namespace awmr::cli {

/// `--resistance`, `--table-error`, `--with`, `--split` and the time-outs.
void add_emit_options(CLI::App& command, EmitOptions& options);

/// Names and hashes of the two files.
Result<EmitInputs> emit_inputs(const std::filesystem::path& model,
                               const std::filesystem::path& gains);

}  // namespace awmr::cli
