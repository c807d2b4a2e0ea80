/// Operations on containers that the standard library of C++20 lacks.
#pragma once

#include <algorithm>
#include <iterator>

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

}  // namespace awmr
