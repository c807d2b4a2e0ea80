/// Compilers used by tests. The target needs `awmr_use_toolchain(TARGET)` (toolchain.cmake).
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "support/process.h"

namespace awmr::testing {

inline constexpr const char* kGcc = AWMR_TOOL_GCC;
inline constexpr const char* kGxx = AWMR_TOOL_GXX;
inline constexpr const char* kClang = AWMR_TOOL_CLANG;
inline constexpr const char* kClangxx = AWMR_TOOL_CLANGXX;
inline constexpr const char* kObjcopy = AWMR_TOOL_OBJCOPY;
inline constexpr const char* kAvrGcc = AWMR_TOOL_AVR_GCC;
inline constexpr const char* kAvrGxx = AWMR_TOOL_AVR_GXX;
inline constexpr const char* kAvrObjcopy = AWMR_TOOL_AVR_OBJCOPY;
inline constexpr const char* kAvrSize = AWMR_TOOL_AVR_SIZE;
inline constexpr const char* kAvrGccAr = AWMR_TOOL_AVR_GCC_AR;
inline constexpr const char* kArmGcc = AWMR_TOOL_ARM_NONE_EABI_GCC;
inline constexpr const char* kArmGxx = AWMR_TOOL_ARM_NONE_EABI_GXX;
inline constexpr const char* kQemuArm = AWMR_TOOL_QEMU_SYSTEM_ARM;

/// Returns the command of a host compiler for use with -c, with the build's compiler cache in front
/// if it is installed. The cache compares contents, so a changed source is compiled again.
inline std::string cached(const std::string& compiler) {
  const std::string_view cache = AWMR_TOOL_CCACHE;
  return cache.ends_with("-NOTFOUND") ? compiler : std::string(cache) + " " + compiler;
}

/// Assertion that CMake found the program when the build was configured.
inline ::testing::AssertionResult found(std::string_view program) {
  if (program.ends_with("-NOTFOUND") || program.empty()) {
    return ::testing::AssertionFailure()
           << program << ": the test needs this program; scripts/setup installs it, then run cmake "
           << "again with --fresh";
  }
  return ::testing::AssertionSuccess();
}

/// Assertion that the program ended with exit code 0; a failure shows its output.
inline ::testing::AssertionResult succeeded(const ProcessResult& result) {
  if (result.exit_code == 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "exit code " << result.exit_code << "\n"
                                       << result.out << result.err;
}

}  // namespace awmr::testing
