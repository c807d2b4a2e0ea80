/// Data layout of runs that are simulated together. A struct of rows, such as State<Row>, has in
/// each field a row: one number of every run. The row of a single run is a double; that of sixteen
/// runs is in lanes/row.h. Private to this folder.
///
/// A step of the loop (vehicle_steps.h, loop_steps.h) is a template on a view of the rows:
/// `view(rows)` are State<T> with the view's scalar T, a double or a register of doubles, and
/// `view.store()` writes them back.
#pragma once

#include <cstddef>
#include <cstring>

/// Marks a step of the loop: everything it calls is inlined, because a call would spill registers.
#define AWMR_WHOLE __attribute__((flatten))

namespace awmr {

/// View of a single run: the numbers themselves.
struct OneRun {
  using Number = double;
  template <class Numbers>
  const Numbers& operator()(const Numbers& numbers) const {
    return numbers;
  }
  template <class Numbers>
  void store(const Numbers& from, Numbers& to) const {
    to = from;
  }
  /// Stores the lanes whose mask is true.
  template <class Numbers>
  void store(bool mask, const Numbers& from, Numbers& to) const {
    if (mask) to = from;
  }
};

/// Number of runs with a value in a row.
template <class Row>
constexpr std::size_t kRunsOf = sizeof(Row) / sizeof(double);

/// Extracts the numbers of one run from a struct of rows. Both structs have only these members, in
/// the same order.
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
