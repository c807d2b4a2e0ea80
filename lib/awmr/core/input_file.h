/// A file as an input of an output: its name and hash.
#pragma once

#include <filesystem>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

/// Hashes a file. Errors: as MappedFile::open.
Result<InputFile> input_file(const std::filesystem::path& path);

}  // namespace awmr
