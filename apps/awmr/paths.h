/// Command-line options whose value is a file or a directory, as help, manual and completions show.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace awmr::cli {

inline constexpr const char* kFileValue = "FILE";
inline constexpr const char* kDirectoryValue = "DIR";

/// Refuses an empty path, and "-", which other programs read as standard input or output.
inline CLI::Validator is_path() {
  return CLI::Validator(
      [](const std::string& path) -> std::string {
        if (path.empty()) return "is empty: give a path";
        if (path == "-") {
          return "'-' (standard input or output) is not supported: give a path; ./- is a file "
                 "named -";
        }
        return "";
      },
      "");
}

/// `path` is a path, an optional path or a list of paths.
template <class Path>
CLI::Option* add_file(CLI::App& command, const std::string& option, Path& path,
                      const std::string& meaning) {
  return command.add_option(option, path, meaning)->type_name(kFileValue)->check(is_path());
}

template <class Path>
CLI::Option* add_directory(CLI::App& command, const std::string& option, Path& path,
                           const std::string& meaning) {
  return command.add_option(option, path, meaning)->type_name(kDirectoryValue)->check(is_path());
}

}  // namespace awmr::cli
