/// Command-line options whose value is a file or a directory. The help, the manual pages and the
/// completions show which of the two.
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

/// Refuses the output path "-", because many programs understand it as standard output, which awmr
/// does not support.
inline CLI::Validator not_standard_output() {
  return CLI::Validator(
      [](const std::string& path) {
        return path == "-" ? "standard output is not supported: give a path; ./- is a file named -"
                           : "";
      },
      "");
}

/// `path` is a path, an optional path or a list of paths.
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
