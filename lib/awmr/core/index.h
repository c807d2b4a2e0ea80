/// Converts between the index types of standard containers (std::size_t) and of Eigen
/// (std::ptrdiff_t), so that formulas need no casts. Indices must not be negative.
#pragma once

#include <cstddef>
#include <type_traits>

namespace awmr {

/// Converts an Eigen index or an enumerator to the index of a standard container: values[at(i)].
template <class Integer>
constexpr std::size_t at(Integer i) {
  static_assert(std::is_integral_v<Integer> || std::is_enum_v<Integer>);
  return static_cast<std::size_t>(i);
}

/// Converts a size or an index of a standard container to Eigen's type.
template <class Integer>
constexpr std::ptrdiff_t eigen_index(Integer i) {
  static_assert(std::is_integral_v<Integer> || std::is_enum_v<Integer>);
  return static_cast<std::ptrdiff_t>(i);
}

/// container.size() in Eigen's type.
template <class Container>
std::ptrdiff_t rows_of(const Container& container) {
  return static_cast<std::ptrdiff_t>(container.size());
}

}  // namespace awmr
