/// Options that take one of a table's names.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

#include "awmr/core/name_table.h"

namespace awmr::cli {

/// Sets `value` to what the name stands for in `names`, which both have to outlive `command`. Any
/// other word is a fault of the command line, and the help shows the names.
template <class Value, std::size_t N>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Value& value,
                        const NameTable<Value, N>& names, const std::string& meaning) {
  const auto set = [&value, &names](const std::string& name) { value = *value_in(names, name); };
  return command.add_option_function<std::string>(option, set, meaning)
      ->check(CLI::IsMember(names_in(names)));
}

}  // namespace awmr::cli
