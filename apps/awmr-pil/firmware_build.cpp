#include "firmware_build.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/files/process.h"

namespace awmr::pil {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFlags[] = {"-mmcu=atmega2560",
                                  "-DF_CPU=16000000UL",
                                  "-std=c++14",
                                  "-mrelax",
                                  "-fno-split-wide-types",
                                  "-fno-tree-switch-conversion",
                                  "-ffunction-sections",
                                  "-fdata-sections",
                                  "-fno-exceptions",
                                  "-fno-threadsafe-statics",
                                  "-Wall",
                                  "-Wextra",
                                  "-Wpedantic",
                                  "-Werror",
                                  "-Wl,--gc-sections",
                                  "-Isrc",
                                  "-Ipil",
                                  "src/awmr.cpp"};
/// Compiler options for few cycles. The options after -O2 keep more values in registers, which
/// saves 350 of the 9,700 cycles of a control step.
constexpr const char* kForSpeed[] = {"-O2", "-mstrict-X", "-fno-tree-pre",
                                     "-fno-move-loop-invariants"};
constexpr const char* kForSize[] = {"-Os", "-mcall-prologues"};

std::span<const char* const> flags_for(cli::Optimize optimize) {
  if (optimize == cli::Optimize::kSize) return kForSize;
  return kForSpeed;
}

/// Time limit of the compiler, s: a hundred times the usual duration, for busy machines.
constexpr double kTimeLimit_s = 200.0;

/// Writes a file of the temporary folder, without flushing it to the disk: only this run needs it.
Status put_temporary(const fs::path& path, std::string_view bytes) {
  AWMR_RETURN_IF_ERROR(make_directory(path.parent_path()));
  std::ofstream file(path, std::ios::binary);
  file << bytes << std::flush;
  if (file) return {};
  return input_error(ErrorCode::kCannotWrite, path.string(),
                     fmt::format("cannot write the file: {}", std::strerror(errno)));
}

/// Checks that no symbolic link could redirect the output. Errors (input): `file`, or a folder
/// between `kept` and `file`, is a symbolic link.
Status check_no_link(const fs::path& kept, const fs::path& file) {
  fs::path place = kept;
  for (const fs::path& part : file) {
    place /= part;
    std::error_code ignored;
    if (fs::is_symlink(fs::symlink_status(place, ignored))) {
      return input_error(ErrorCode::kWouldOverwrite, place.string(),
                         "is a symbolic link in the folder of --build-dir, and its target would be "
                         "overwritten: remove the link, or give another folder");
    }
  }
  return {};
}

}  // namespace

Result<fs::path> build_firmware(const fs::path& directory, const std::vector<EmittedFile>& library,
                                const FirmwareKind& kind) {
  for (const EmittedFile& file : library) {
    AWMR_RETURN_IF_ERROR(put_temporary(directory / file.path, file.bytes));
  }
  for (const auto& [name, bytes] : firmware_sources()) {
    AWMR_RETURN_IF_ERROR(put_temporary(directory / "pil" / std::string(name), bytes));
  }
  AWMR_RETURN_IF_ERROR(put_temporary(directory / "pil" / "mission.h", kind.mission));
  const auto compiler = find_program("avr-g++");
  if (!compiler) {
    return input_error(ErrorCode::kNotInstalled, "avr-g++",
                       "is not installed; it builds the firmware: "
                       "apt-get install gcc-avr avr-libc binutils-avr");
  }
  const std::string program = kind.link == LinkKind::kMemory ? "pil_memory" : "pil_uart";
  ProgramCall call{.program = *compiler,
                   .arguments{std::begin(kFlags), std::end(kFlags)},
                   .directory = directory,
                   .environment = plain_environment(directory),
                   .time_limit_s = kTimeLimit_s};
  const auto flags = flags_for(kind.optimize);
  append(call.arguments, flags);
  call.arguments.push_back(kind.is_directed ? "-DAWMR_WITH_DIRECTION=1"
                                            : "-DAWMR_WITH_DIRECTION=0");
  call.arguments.push_back(kind.is_estimated ? "-DAWMR_WITH_POSITION_ESTIMATE=1"
                                             : "-DAWMR_WITH_POSITION_ESTIMATE=0");
  call.arguments.insert(call.arguments.end(), {"pil/" + program + ".cpp", "-o", program + ".elf"});
  AWMR_ASSIGN_OR_RETURN(const ProgramEnd built, run_program(call));
  if (built.timed_out) {
    return program_fault(
        fmt::format("the compiler {} did not end within {} s", compiler->string(), kTimeLimit_s));
  }
  if (built.exit_code != 0) {
    return program_fault(fmt::format("the firmware does not compile:\n{}", built.output));
  }
  return directory / (program + ".elf");
}

Status prepare_to_keep(const fs::path& kept) {
  const std::string name = kept.string();
  if (name.empty()) {
    return input_error(ErrorCode::kBadName, "--build-dir",
                       "the name of the folder is empty: give the folder for the firmware");
  }
  if (name.starts_with('-')) {
    return input_error(
        ErrorCode::kBadName, "--build-dir",
        fmt::format("'{0}' looks like an option; a folder of that name is './{0}'", name));
  }
  AWMR_RETURN_IF_ERROR(make_directory(kept));
  if (::access(kept.c_str(), W_OK | X_OK) != 0) {
    return input_error(ErrorCode::kCannotWrite, name,
                       fmt::format("cannot write to the folder: {}", std::strerror(errno)));
  }
  return {};
}

Status keep_firmware(const fs::path& directory, const fs::path& kept) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory)) {
    if (!entry.is_regular_file()) continue;
    const fs::path file = entry.path().lexically_relative(directory);
    AWMR_RETURN_IF_ERROR(check_no_link(kept, file));
    AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_file(entry.path()));
    const fs::path copy = kept / file;
    AWMR_RETURN_IF_ERROR(make_directory(copy.parent_path()));
    AWMR_RETURN_IF_ERROR(write_file(copy, bytes));
  }
  return {};
}

}  // namespace awmr::pil
