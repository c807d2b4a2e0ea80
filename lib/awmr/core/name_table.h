/// Table of the names of an enumeration's values, for files, options and messages.
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

/// A value of the enumeration and its name in files, options and messages.
template <class T>
struct Named {
  std::string_view name;
  T value;
};

/// One entry for each of the N values.
template <class T, std::size_t N>
using NameTable = std::array<Named<T>, N>;

/// Name of a value; empty if the table does not have the value.
template <class T, std::size_t N>
constexpr std::string_view name_in(const NameTable<T, N>& table, T value) {
  for (const Named<T>& entry : table) {
    if (entry.value == value) return entry.name;
  }
  return {};
}

/// Value of a name; none if the table does not have the name.
template <class T, std::size_t N>
constexpr std::optional<T> value_in(const NameTable<T, N>& table, std::string_view name) {
  for (const Named<T>& entry : table) {
    if (entry.name == name) return entry.value;
  }
  return std::nullopt;
}

/// All values, in table order.
template <class T, std::size_t N>
std::vector<T> values_in(const NameTable<T, N>& table) {
  std::vector<T> values;
  for (const Named<T>& entry : table) values.push_back(entry.value);
  return values;
}

/// All names, in table order.
template <class T, std::size_t N>
std::vector<std::string> names_in(const NameTable<T, N>& table) {
  std::vector<std::string> names;
  for (const Named<T>& entry : table) names.emplace_back(entry.name);
  return names;
}

}  // namespace awmr
