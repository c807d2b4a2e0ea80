#include "interpolated_readings.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/containers.h"
#include "awmr/core/sample_quantile.h"
#include "even_times.h"

namespace awmr {
namespace {

/// True if the rows between two corners are on the line between them.
bool is_straight(const LinedColumn& column, const Readings& corners, std::size_t first) {
  const double begin_s = corners.t_s[first];
  const double end_s = corners.t_s[first + 1];
  const double slope = (corners.value[first + 1] - corners.value[first]) / (end_s - begin_s);
  auto row = static_cast<std::size_t>(
      std::upper_bound(column.t_s.begin(), column.t_s.end(), begin_s) - column.t_s.begin());
  for (; row < column.rows() && column.t_s[row] < end_s; ++row) {
    const double line = corners.value[first] + slope * (column.t_s[row] - begin_s);
    if (std::abs(column.value[row] - line) > 2.0 * column.tolerance) return false;
  }
  return true;
}

std::vector<double> every(std::size_t stride, std::span<const double> values) {
  std::vector<double> some;
  for (std::size_t i = 0; i < values.size(); i += stride) some.push_back(values[i]);
  return some;
}

/// Adds readings that are on the line between their neighbours and therefore no corners, at equal
/// time spans: up to two in a row, or any number if the value does not change (at rest). A longer
/// slanted line is a gap in the readings.
Readings with_readings_on_lines(const LinedColumn& column, const Readings& corners) {
  constexpr double kMostParts = 3.0;
  const double usual_s = median_step_of(corners.t_s);
  Readings all;
  for (std::size_t i = 0; i < corners.t_s.size(); ++i) {
    all.t_s.push_back(corners.t_s[i]);
    all.value.push_back(corners.value[i]);
    if (i + 1 == corners.t_s.size()) break;
    const double gap_s = corners.t_s[i + 1] - corners.t_s[i];
    const double rise = corners.value[i + 1] - corners.value[i];
    const double parts = std::round(gap_s / usual_s);
    const bool is_rest = std::abs(rise) <= column.tolerance;
    if ((parts > kMostParts && !is_rest) || !is_straight(column, corners, i)) continue;
    for (double part = 1.0; part < parts; part += 1.0) {
      all.t_s.push_back(corners.t_s[i] + part / parts * gap_s);
      all.value.push_back(corners.value[i] + part / parts * rise);
    }
  }
  return all;
}

/// If the readings are evenly spaced, replaces the times of corners, which are uncertain where two
/// lines have about the same slope, by t_0 + n_k h. Criterion: most corners are within 5 % of a row
/// of these times. Corners that are more than half a row off, and a second corner with the same
/// number, are dropped. The first and the last row are no corners.
Readings at_even_times(const LinedColumn& column, Readings corners) {
  const double row_s = median_step_of(column.t_s);
  const double usual_s = median_step_of(corners.t_s);
  std::vector<double> numbers{0.0};
  for (std::size_t k = 1; k < corners.t_s.size(); ++k) {
    numbers.push_back(numbers.back() + std::round((corners.t_s[k] - corners.t_s[k - 1]) / usual_s));
  }
  // Fit all corners, then only those near the fit before.
  EvenTimes even = even_times(corners.t_s, numbers);
  for (const double most_off_s : {0.5 * row_s, 0.25 * row_s}) {
    std::vector<std::size_t> near;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (std::abs(corners.t_s[k] - even.at(numbers[k])) <= most_off_s) near.push_back(k);
    }
    if (near.size() < numbers.size() / 2) return corners;
    even = even_times(picked(corners.t_s, near), picked(numbers, near));
  }
  std::vector<double> off_s;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    off_s.push_back(std::abs(corners.t_s[k] - even.at(numbers[k])));
  }
  constexpr double kEven = 0.05;
  if (median(off_s) > kEven * row_s) return corners;
  Readings at_even;
  double last_number = -1.0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const double at_s = even.at(numbers[k]);
    if (off_s[k] > 0.5 * row_s || numbers[k] == last_number) continue;
    last_number = numbers[k];
    at_even.t_s.push_back(at_s);
    const double slack_s = 1e-3 * row_s;
    at_even.value.push_back(
        value_at(column, at_s, at_s - even.step_s - slack_s, at_s + even.step_s + slack_s));
  }
  return at_even;
}

/// True if readings at their usual time spans cover at least 80 % of the time of the column. If they
/// do not, only a part of the rows is interpolated.
bool cover(const Readings& readings, const LinedColumn& column) {
  constexpr double kNearlyAll = 0.8;
  const double covered_s = static_cast<double>(readings.t_s.size()) * median_step_of(readings.t_s);
  return covered_s >= kNearlyAll * (column.t_s.back() - column.t_s.front());
}

}  // namespace

std::optional<Readings> interpolated_readings(std::span<const double> t_s,
                                              std::span<const double> value, double rounding) {
  constexpr std::size_t kFewestRows = 50;
  // Rounding hides corners of short lines. In a column with fewer rows, the corners are sharper.
  for (const std::size_t stride : {1, 2, 4}) {
    const std::vector<double> some_s = every(stride, t_s);
    const std::vector<double> some = every(stride, value);
    if (some.size() < kFewestRows) break;
    const LinedColumn column = lined_column(some_s, some, rounding);
    if (!has_lines(column)) continue;
    const Readings corners = corners_of(column);
    if (!are_evenly_spaced(column, corners)) continue;
    const Readings readings = with_readings_on_lines(column, at_even_times(column, corners));
    if (cover(readings, column)) return readings;
  }
  return std::nullopt;
}

std::optional<Readings> interpolated_between(std::span<const double> readings_s,
                                             std::span<const double> t_s,
                                             std::span<const double> value, double rounding) {
  constexpr double kNearlyAll = 0.9;
  constexpr double kFewest = 5.0;
  const LinedColumn column = lined_column(t_s, value, rounding);
  double inside = 0.0;  // rows whose neighbours are between the same two readings
  double on_line = 0.0;
  double corners = 0.0;
  std::size_t next = 0;  // first reading later than the row before
  for (std::size_t i = 1; i + 1 < column.rows(); ++i) {
    const double slack_s = 1e-3 * (t_s[i] - t_s[i - 1]);
    while (next < readings_s.size() && readings_s[next] <= t_s[i - 1] + slack_s) ++next;
    if (column.is_flat[i]) continue;
    if (next < readings_s.size() && readings_s[next] < t_s[i + 1] - slack_s) {
      if (!column.is_on_line(i)) corners += 1.0;
      continue;
    }
    inside += 1.0;
    if (column.is_on_line(i)) on_line += 1.0;
  }
  if (inside < kFewest || corners < kFewest || on_line < kNearlyAll * inside) return std::nullopt;
  Readings readings;
  for (std::size_t k = 0; k < readings_s.size(); ++k) {
    const double slack_s = 1e-3 * (t_s[1] - t_s[0]);
    const double previous_s = k > 0 ? readings_s[k - 1] - slack_s : t_s.front();
    const double next_s = k + 1 < readings_s.size() ? readings_s[k + 1] + slack_s : t_s.back();
    readings.t_s.push_back(readings_s[k]);
    readings.value.push_back(value_at(column, readings_s[k], previous_s, next_s));
  }
  return readings;
}

std::optional<Readings> changing_at(std::span<const double> readings_s, std::span<const double> t_s,
                                    std::span<const double> value) {
  constexpr double kFewest = 10.0;
  constexpr double kNearlyAll = 0.97;
  const double slack_s = 1e-3 * (t_s[1] - t_s[0]);
  Readings readings;
  double changes = 0.0;
  double after_reading = 0.0;  // changes in the first row after a reading
  for (std::size_t row = 1, next = 0; row < value.size(); ++row) {
    const std::size_t before = next;
    while (next < readings_s.size() && readings_s[next] <= t_s[row] + slack_s) {
      readings.t_s.push_back(readings_s[next++]);
      readings.value.push_back(value[readings.t_s.back() > t_s[row - 1] + slack_s ? row : row - 1]);
    }
    if (value[row] == value[row - 1]) continue;
    changes += 1.0;
    if (next > before) after_reading += 1.0;
  }
  if (changes < kFewest || after_reading < kNearlyAll * changes) return std::nullopt;
  return readings;
}

double printed_resolution(std::span<const double> value) {
  constexpr double kOff = 1e-6;
  double unit = 1.0;
  for (int digits = 0; digits < 10; ++digits, unit *= 0.1) {
    const bool are_multiples = std::ranges::all_of(value, [unit](double v) {
      const double times = v / unit;
      return std::abs(times - std::round(times)) <= kOff + 1e-14 * std::abs(times);
    });
    if (are_multiples) return unit;
  }
  return 0.0;
}

}  // namespace awmr
