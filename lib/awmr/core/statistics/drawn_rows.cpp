#include "awmr/core/statistics/drawn_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace awmr {
namespace {

/// Range (largest minus smallest value) of each signal.
std::vector<double> ranges_of(std::span<const std::vector<double>> signals) {
  std::vector<double> ranges;
  for (const std::vector<double>& signal : signals) {
    const auto [low, high] = std::minmax_element(signal.begin(), signal.end());
    ranges.push_back(*high - *low);
  }
  return ranges;
}

struct Farthest {
  std::size_t row = 0;
  double distance = 0.0;  ///< distance of the row from the line, over the signal's range
};

/// Finds the row between `first` and `last` that is farthest, in any signal, from the straight line
/// between these two rows.
Farthest farthest_row(std::span<const double> t, std::span<const std::vector<double>> signals,
                      std::span<const double> ranges, std::size_t first, std::size_t last) {
  Farthest farthest;
  const double span = t[last] - t[first];
  for (std::size_t k = 0; k < signals.size(); ++k) {
    const std::vector<double>& y = signals[k];
    if (!(ranges[k] > 0.0)) continue;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double share = span > 0.0 ? (t[i] - t[first]) / span : 0.0;
      const double line = y[first] + share * (y[last] - y[first]);
      const double distance = std::abs(y[i] - line) / ranges[k];
      if (distance > farthest.distance) farthest = {i, distance};
    }
  }
  return farthest;
}

std::vector<std::size_t> rows_within(std::span<const double> t,
                                     std::span<const std::vector<double>> signals,
                                     std::span<const double> ranges, double tolerance) {
  std::vector<std::size_t> rows{0};
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, t.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const Farthest far = farthest_row(t, signals, ranges, first, last);
    if (far.distance > tolerance) {
      open.emplace_back(far.row, last);  // the earlier half is pushed last, to be handled first
      open.emplace_back(first, far.row);
    } else {
      rows.push_back(last);
    }
  }
  return rows;
}

}  // namespace

std::vector<std::size_t> drawn_rows(std::span<const double> t,
                                    std::span<const std::vector<double>> signals, double tolerance,
                                    std::size_t most) {
  if (t.empty()) return {};
  if (t.size() == 1) return {0};
  const std::vector<double> ranges = ranges_of(signals);
  std::vector<std::size_t> rows = rows_within(t, signals, ranges, tolerance);
  while (rows.size() > most) {
    tolerance *= 2.0;
    rows = rows_within(t, signals, ranges, tolerance);
  }
  return rows;
}

double rounded_number(double x, int digits) {
  return std::strtod(fmt::format("{:.{}g}", x, digits).c_str(), nullptr);
}

double drawn_number(double x) { return rounded_number(x, 5); }

}  // namespace awmr
