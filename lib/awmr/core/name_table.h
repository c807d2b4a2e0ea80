/// The names of an enumeration's values, in one table: for files, options and messages alike.
///
///     inline constexpr NameTable<Colour, 2> kColourNames{{{"red", Colour::kRed},
///                                                         {"blue", Colour::kBlue}}};
///     name_in(kColourNames, Colour::kRed);  // "red"
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace awmr {

/// A value and the name it has outside of the program.
template <class T>
struct Named {
  std::string_view name;
  T value;
};

/// One entry for each of the enumeration's N values.
template <class T, std::size_t N>
using NameTable = std::array<Named<T>, N>;

/// The name of a value; empty for a value that the table does not have.
template <class T, std::size_t N>
constexpr std::string_view name_in(const NameTable<T, N>& table, T value) {
  for (const Named<T>& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return {};
}

/// The value of a name; none where the table has no such name.
template <class T, std::size_t N>
constexpr std::optional<T> value_in(const NameTable<T, N>& table, std::string_view name) {
  for (const Named<T>& entry : table) {
    if (entry.name == name) return entry.value;
  }
  return std::nullopt;
}

/// All values, in the order of the table.
template <class T, std::size_t N>
std::vector<T> values_in(const NameTable<T, N>& table) {
  std::vector<T> values;
  for (const Named<T>& entry : table) values.push_back(entry.value);
  return values;
}

/// All names, in the order of the table.
template <class T, std::size_t N>
std::vector<std::string> names_in(const NameTable<T, N>& table) {
  std::vector<std::string> names;
  for (const Named<T>& entry : table) names.emplace_back(entry.name);
  return names;
}

}  // namespace awmr
