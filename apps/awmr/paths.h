/// Options whose value is a file or a directory: help, manual and completions all see which.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace awmr::cli {

inline constexpr const char* kFileValue = "FILE";
inline constexpr const char* kDirectoryValue = "DIR";

inline CLI::Validator not_empty() {
  return CLI::Validator(
      [](const std::string& path) { return path.empty() ? "is empty: give a path" : ""; }, "");
}

/// `path` is a path, perhaps optional, or a list of them.
template <class Path>
CLI::Option* add_file(CLI::App& command, const std::string& option, Path& path,
                      const std::string& meaning) {
  return command.add_option(option, path, meaning)->type_name(kFileValue)->check(not_empty());
}

template <class Path>
CLI::Option* add_directory(CLI::App& command, const std::string& option, Path& path,
                           const std::string& meaning) {
  return command.add_option(option, path, meaning)->type_name(kDirectoryValue)->check(not_empty());
}

}  // namespace awmr::cli
