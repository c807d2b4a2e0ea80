/// Input files, each read once, so that the hash in an output is that of the bytes used. A pipe
/// gives its bytes only once, and a file can change between two reads.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "awmr/core/file.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

/// As read_file; also records the hash under the path. The records are per process, one per path,
/// and thread-safe.
Result<std::string> read_input(const std::filesystem::path& path,
                               std::size_t max_bytes = kMaxFileBytes);

/// The file's name and the hash of the bytes last read from it. Reads the file if it was not read
/// yet. Errors: as read_file.
Result<InputFile> input_file(const std::filesystem::path& path);

}  // namespace awmr
