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

/// Build configuration.
struct FirmwareKind {
  LinkKind link = LinkKind::kMemory;
  cli::Optimize optimize = cli::Optimize::kSpeed;
  std::string mission;        ///< mission_header()
  bool is_directed = false;   ///< the speed sensor has no sign: the firmware finds the direction
  bool is_estimated = false;  ///< positions are GPS fixes: the firmware estimates in between
};

/// Writes the emitted library and the link's program to `directory`, which is private and empty,
/// and builds them there. Returns the ELF file. Errors: (input) no avr-g++ in PATH, with the
/// package to install; (fault) compilation fails, with the compiler's output, or takes minutes.
Result<std::filesystem::path> build_firmware(const std::filesystem::path& directory,
                                             const std::vector<EmittedFile>& library,
                                             const FirmwareKind& kind);

/// Creates the directory in which the firmware is kept. Errors (input): the name looks like an
/// option; it cannot be created or written to.
Status prepare_to_keep(const std::filesystem::path& kept);

/// Copies the build from `directory` to `kept`. Errors (input): a file cannot be written; `kept`
/// contains a symbolic link where a file would be written.
Status keep_firmware(const std::filesystem::path& directory, const std::filesystem::path& kept);

}  // namespace awmr::pil
