/// Input files, each read once: the hash that an output names is the hash of what was read. A pipe
/// gives its bytes only once, and a file may change between two readings.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "awmr/core/file.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

/// As read_file, and notes the hash under the path. The notes are the process's own, a line per
/// path, and safe to use from several threads.
Result<std::string> read_input(const std::filesystem::path& path,
                               std::size_t max_bytes = kMaxFileBytes);

/// Notes the hash of what was read otherwise, in pieces.
void note_input(const std::filesystem::path& path, std::string sha256);

/// The file's name, and the hash of what was last read of it; reads it if nothing was. Errors: as
/// read_file.
Result<InputFile> input_file(const std::filesystem::path& path);

}  // namespace awmr
