// The firmware of one model, built with avr-gcc.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/emit/emit.h"

namespace awmr::pil {

enum class LinkKind { kMemory, kUart };

/// Writes the emitted library and the link's program to `directory` and builds them there.
/// Returns the ELF file. Errors (input): no avr-g++ on the path, with what to install; (fault): it
/// does not compile, with the compiler's words.
Result<std::filesystem::path> build_firmware(const std::filesystem::path& directory,
                                             const std::vector<EmittedFile>& library,
                                             LinkKind link);

}  // namespace awmr::pil
