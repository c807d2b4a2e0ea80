/// Values of command-line options: names, numbers, files and directories.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "awmr/core/name_table.h"
#include "awmr/core/nearest.h"

namespace awmr::cli {

/// Validator that accepts only these names and lists them in the help.
inline CLI::Validator one_of(std::vector<std::string> names) {
  std::string shown = fmt::format("{{{}}}", fmt::join(names, ","));
  const auto check = [names = std::move(names)](const std::string& word) -> std::string {
    if (std::find(names.begin(), names.end(), word) != names.end()) return {};
    return fmt::format("'{}' is not one of {}{}", word, fmt::join(names, ", "),
                       did_you_mean(word, names));
  };
  return {check, std::move(shown), ""};
}

/// Adds an option that sets `value` to the entry of `names` with the given name. Any other name is
/// a command-line error. The help lists the names. `value` (a Value or an optional one) and `names`
/// must outlive `command`.
template <class Target, class Value, std::size_t N>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Target& value,
                        const NameTable<Value, N>& names, const std::string& meaning) {
  const auto set = [&value, &names](const std::string& name) { value = *value_in(names, name); };
  return command.add_option_function<std::string>(option, set, meaning)
      ->check(one_of(names_in(names)));
}

/// Largest random seed.
inline constexpr std::uint64_t kAnySeed = std::numeric_limits<std::uint64_t>::max();

/// Accepts a finite number from `min` to `max` without further text: for an integer type a whole
/// number, for an unsigned type without minus sign. CLI11's own check would convert -1 and 10^23 to
/// 2^64 - 1, and accept nan in every range.
template <class Number>
CLI::Validator within(Number min, Number max) {
  static_assert(std::is_arithmetic_v<Number>);
  const auto check = [min, max](const std::string& text) -> std::string {
    const std::size_t sign = !text.empty() && text.front() == '+' ? 1 : 0;
    const char* const end = text.data() + text.size();
    Number value{};
    const auto [stop, fault] = std::from_chars(text.data() + sign, end, value);
    bool good = fault == std::errc() && stop == end && value >= min && value <= max;
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (good) return {};
    const char* const kind = std::is_integral_v<Number> ? "whole number" : "number";
    return fmt::format("must be a {} from {} to {}, found {}", kind, min, max,
                       text.empty() ? "nothing" : text);
  };
  return {check, fmt::format("in [{}, {}]", min, max), ""};
}

/// Type of a value that is a file or a directory: shown by the help, the manual pages and the
/// completions.
inline constexpr const char* kFileValue = "FILE";
inline constexpr const char* kDirectoryValue = "DIR";

inline CLI::Validator not_empty() {
  return CLI::Validator(
      [](const std::string& path) { return path.empty() ? "is empty: give a path" : ""; }, "");
}

/// Refuses the output path "-", which means standard output in many programs. awmr does not support
/// it.
inline CLI::Validator not_standard_output() {
  return CLI::Validator(
      [](const std::string& path) {
        return path == "-" ? "standard output is not supported: give a path; ./- is a file named -"
                           : "";
      },
      "");
}

/// Adds an option whose value is the path of a file. `path`: variable for the value, a path, an
/// optional path or a list of paths.
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
