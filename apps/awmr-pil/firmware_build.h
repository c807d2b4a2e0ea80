// The firmware of one model, built with avr-gcc.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/emit/emit.h"
#include "pil_options.h"

namespace awmr::pil {

enum class LinkKind { kMemory, kUart };

/// What is built.
struct FirmwareKind {
  LinkKind link = LinkKind::kMemory;
  cli::Optimize optimize = cli::Optimize::kSpeed;
  std::string mission;       ///< mission_header()
  bool is_directed = false;  ///< the speed has no sign, its direction is computed
};

/// Writes the emitted library and the link's program to `directory`, which is private and empty,
/// and builds them there. Returns the ELF file. Errors (input): no avr-g++ on the path, with what
/// to install; (fault): it does not compile, with the compiler's words, or takes minutes.
Result<std::filesystem::path> build_firmware(const std::filesystem::path& directory,
                                             const std::vector<EmittedFile>& library,
                                             const FirmwareKind& kind);

/// Makes the folder in which the firmware is to be kept. Errors (input): the name looks like an
/// option; it cannot be made or written to.
Status prepare_to_keep(const std::filesystem::path& kept);

/// Copies what was built from `directory` to `kept`. Errors (input): a file cannot be written; in
/// `kept` a symbolic link stands in its place, through which something else would be overwritten.
Status keep_firmware(const std::filesystem::path& directory, const std::filesystem::path& kept);

}  // namespace awmr::pil
