/// Indices without casts in the mathematics. Standard containers count in std::size_t, Eigen in
/// std::ptrdiff_t; both are non-negative here.
#pragma once

#include <cstddef>
#include <type_traits>

namespace awmr {

/// An index or a size of Eigen's for a standard container: values[at(i)].
template <class Integer>
constexpr std::size_t at(Integer i) {
  static_assert(std::is_integral_v<Integer> || std::is_enum_v<Integer>);
  return static_cast<std::size_t>(i);
}

/// The size of a standard container, or an index into it, as Eigen counts.
template <class Integer>
constexpr std::ptrdiff_t eigen_index(Integer i) {
  static_assert(std::is_integral_v<Integer> || std::is_enum_v<Integer>);
  return static_cast<std::ptrdiff_t>(i);
}

/// container.size() as Eigen counts.
template <class Container>
std::ptrdiff_t rows_of(const Container& container) {
  return static_cast<std::ptrdiff_t>(container.size());
}

}  // namespace awmr
