/// Command-line options whose value is one of several fixed names.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/name_table.h"
#include "command_line.h"

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
/// a command-line error. The help lists the names. `value` and `names` must outlive `command`.
template <class Value, std::size_t N>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Value& value,
                        const NameTable<Value, N>& names, const std::string& meaning) {
  const auto set = [&value, &names](const std::string& name) { value = *value_in(names, name); };
  return command.add_option_function<std::string>(option, set, meaning)
      ->check(one_of(names_in(names)));
}

}  // namespace awmr::cli
