// Builds the firmware for one model with avr-gcc.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
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
  bool is_directed = false;   ///< true: the firmware finds the sign of the speed
  bool is_estimated = false;  ///< true: the firmware estimates positions between GPS fixes
};

/// Builds the firmware in `directory`, which must be private and empty: writes the emitted library
/// and the main program there, compiles them, and returns the ELF file. Errors: (input) avr-g++ is
/// not in PATH (the message names the package to install); (fault) compilation fails (the message
/// has the compiler's output) or exceeds its time limit.
Result<std::filesystem::path> build_firmware(const std::filesystem::path& directory,
                                             const std::vector<EmittedFile>& library,
                                             const FirmwareKind& kind);

/// Creates the directory `kept` of --build-dir, in which the firmware remains after the run. Errors
/// (input): its name looks like an option; the directory cannot be created or written to.
Status prepare_to_keep(const std::filesystem::path& kept);

/// Copies the sources and the ELF file of the build from `directory` to `kept`. Errors (input): a
/// file cannot be written; a file or folder of the build is a symbolic link in `kept`.
Status keep_firmware(const std::filesystem::path& directory, const std::filesystem::path& kept);

/// Name and content of each source file of the firmware; they are compiled into the program.
const std::vector<std::pair<std::string_view, std::string_view>>& firmware_sources();

}  // namespace awmr::pil
