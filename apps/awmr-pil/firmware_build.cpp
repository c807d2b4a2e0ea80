#include "firmware_build.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdlib>

#include "awmr/core/file.h"
#include "firmware_sources.h"

namespace awmr::pil {
namespace {

namespace fs = std::filesystem;

/// -mcall-prologues, -mrelax and what follows: a tenth less flash for a fiftieth more cycles.
constexpr const char* kFlags =
    "-mmcu=atmega2560 -DF_CPU=16000000UL -std=c++14 -Os -mcall-prologues -mrelax "
    "-fno-split-wide-types -fno-tree-switch-conversion "
    "-ffunction-sections -fdata-sections -fno-exceptions -fno-threadsafe-statics -Wall -Wextra "
    "-Wpedantic -Werror -Wl,--gc-sections";

Status put(const fs::path& path, std::string_view bytes) {
  if (auto made = make_directory(path.parent_path()); !made) return made;
  return write_file(path, bytes);
}

int exit_code_of(const std::string& line) {
  const int status = std::system(line.c_str());  // NOLINT(concurrency-mt-unsafe): one thread
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

Result<fs::path> build_firmware(const fs::path& directory, const std::vector<EmittedFile>& library,
                                LinkKind link) {
  for (const EmittedFile& file : library) {
    if (auto done = put(directory / file.path, file.bytes); !done) {
      return tl::unexpected(done.error());
    }
  }
  for (const auto& [name, bytes] : firmware_sources()) {
    if (auto done = put(directory / "pil" / std::string(name), bytes); !done) {
      return tl::unexpected(done.error());
    }
  }
  if (exit_code_of("command -v avr-g++ >/dev/null 2>&1") != 0) {
    return input_error("avr-g++",
                       "is not installed; it builds the firmware: "
                       "apt-get install gcc-avr avr-libc binutils-avr");
  }
  const char* program = link == LinkKind::kMemory ? "pil_memory" : "pil_uart";
  const std::string line =
      fmt::format("cd '{}' && avr-g++ {} -Isrc -Ipil src/awmr.cpp pil/{}.cpp -o {}.elf 2>build.log",
                  directory.string(), kFlags, program, program);
  if (exit_code_of(line) != 0) {
    const auto log = read_file(directory / "build.log");
    return program_fault(
        fmt::format("the firmware does not compile:\n{}", log ? *log : std::string()));
  }
  return directory / (std::string(program) + ".elf");
}

}  // namespace awmr::pil
