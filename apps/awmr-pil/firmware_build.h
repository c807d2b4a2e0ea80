// Builds the firmware for one model with avr-gcc.
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
  std::string mission;        ///< content of mission.h, by mission_header()
  bool is_directed = false;   ///< true: the measured speed has no sign; the firmware finds it
  bool is_estimated = false;  ///< true: the firmware estimates positions between GPS fixes
};

/// Writes the emitted library and the program of the link to `directory`, which is private and
/// empty, and builds them there. Returns the ELF file. Errors: (input) avr-g++ is not in PATH (the
/// message names the package to install); (fault) compilation fails (the message has the compiler's
/// output) or exceeds its time limit.
Result<std::filesystem::path> build_firmware(const std::filesystem::path& directory,
                                             const std::vector<EmittedFile>& library,
                                             const FirmwareKind& kind);

/// Creates the directory in which the firmware is kept. Errors (input): its name looks like an
/// option; the directory cannot be created or written to.
Status prepare_to_keep(const std::filesystem::path& kept);

/// Copies sources and ELF file of the build from `directory` to `kept`. Errors (input): a file
/// cannot be written; `kept` contains a symbolic link in the place of a file or folder of the
/// build.
Status keep_firmware(const std::filesystem::path& directory, const std::filesystem::path& kept);

}  // namespace awmr::pil
