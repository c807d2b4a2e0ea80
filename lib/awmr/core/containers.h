/// Operations on containers that the standard library of C++20 lacks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace awmr {

/// Appends all elements of `more` to the container `to`.
template <class Container, class More>
void append(Container& to, const More& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// True if an element of the range equals `value`.
template <class Range, class Value>
bool contains(const Range& range, const Value& value) {
  return std::find(std::begin(range), std::end(range), value) != std::end(range);
}

/// Returns the values at the given indices.
template <class T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<std::size_t>& indices) {
  std::vector<T> some;
  some.reserve(indices.size());
  for (const std::size_t index : indices) some.push_back(values[index]);
  return some;
}

}  // namespace awmr
