/// Data layout of runs that are simulated together. In a struct of rows, such as State<Row>, each
/// field is a row: one number of every run. The row of a single run is a double; the row of sixteen
/// runs is lanes::Row. Private to this folder.
///
/// A function of the loop (vehicle_steps.h, loop_steps.h) is a template on a view, which selects
/// one or several runs of the rows. The view's scalar type T (View::Number) is a double, or
/// lanes::Lanes with one double per run. For example, `view(rows)` loads State<Row> as State<T>,
/// and `view.store()` writes it back.
#pragma once

#include <cstddef>
#include <cstring>

/// Attribute of a function of the loop: the compiler inlines all functions that it calls.
/// Otherwise, each call would move the contents of registers to memory, which is slow.
#define AWMR_WHOLE __attribute__((flatten))

namespace awmr {

/// View for a single run: a row is one number of the type T. T is double, or the type with which
/// tests/bench counts operations, which has the same size.
template <class T>
struct OneRunOf {
  using Number = T;
  template <class Numbers>
  const Numbers& operator()(const Numbers& numbers) const {
    return numbers;
  }
  template <class Numbers>
  void store(const Numbers& from, Numbers& to) const {
    to = from;
  }
  /// Stores the numbers if the mask is true.
  template <class Numbers>
  void store(bool mask, const Numbers& from, Numbers& to) const {
    if (mask) to = from;
  }
};
using OneRun = OneRunOf<double>;

/// Number of runs in a row.
template <class Row>
constexpr std::size_t kRunsOf = sizeof(Row) / sizeof(double);

/// Extracts the numbers of one run from a struct of rows. Precondition: `Numbers` has only doubles,
/// and `Rows` has a row for each of them, in the same order.
template <class Numbers, class Rows>
Numbers run_of(const Rows& rows, std::size_t run) {
  constexpr std::size_t kCount = sizeof(Numbers) / sizeof(double);
  constexpr std::size_t kRowSize = sizeof(Rows) / kCount;
  static_assert(kCount * kRowSize == sizeof(Rows));
  Numbers numbers;
  for (std::size_t i = 0; i < kCount; ++i) {
    std::memcpy(reinterpret_cast<char*>(&numbers) + i * sizeof(double),
                reinterpret_cast<const char*>(&rows) + i * kRowSize + run * sizeof(double),
                sizeof(double));
  }
  return numbers;
}
/// Stores the numbers of one run in a struct of rows.
template <class Numbers, class Rows>
void put(const Numbers& numbers, std::size_t run, Rows& rows) {
  constexpr std::size_t kCount = sizeof(Numbers) / sizeof(double);
  constexpr std::size_t kRowSize = sizeof(Rows) / kCount;
  static_assert(kCount * kRowSize == sizeof(Rows));
  for (std::size_t i = 0; i < kCount; ++i) {
    std::memcpy(reinterpret_cast<char*>(&rows) + i * kRowSize + run * sizeof(double),
                reinterpret_cast<const char*>(&numbers) + i * sizeof(double), sizeof(double));
  }
}

}  // namespace awmr
