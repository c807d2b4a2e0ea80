/// Reads input files and records their hashes. Each file is read only once. So the hash in an
/// output is the hash of the bytes used, even if the file changes later or is a pipe.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "awmr/core/file.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

/// As read_file(), and records the hash of the bytes for input_file(). A later call with the same
/// path replaces the record. Thread-safe.
Result<std::string> read_input(const std::filesystem::path& path,
                               std::size_t max_bytes = kMaxFileBytes);

/// The name of the file, and the hash of the bytes that read_input() last read from it. Reads the
/// file if this was not done yet. Errors: those of read_file().
Result<InputFile> input_file(const std::filesystem::path& path);

}  // namespace awmr
