#include "line_chain.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/statistics/sample_quantile.h"
#include "even_times.h"

namespace awmr {
namespace {

double slope_from(const LinedColumn& column, std::size_t row) {
  return (column.value[row + 1] - column.value[row]) / (column.t_s[row + 1] - column.t_s[row]);
}

/// Adds the corner between the line that ends with `row` and the line that begins with the next
/// row. Adds nothing if the lines do not intersect between these rows.
void add_corner_after(const LinedColumn& column, std::size_t row, Readings& corners) {
  const double begin_s = column.t_s[row];
  const double end_s = column.t_s[row + 1];
  const double before = slope_from(column, row - 1);
  const double after = slope_from(column, row + 1);
  const double turn = std::abs(after - before);
  const double step_s = end_s - begin_s;
  double at_s = 0.5 * (begin_s + end_s);
  if (turn * step_s > 4.0 * column.tolerance) {
    at_s =
        begin_s + (column.value[row + 1] - after * step_s - column.value[row]) / (before - after);
    const double slack_s = 0.1 * step_s + 2.0 * column.tolerance / turn;
    if (at_s < begin_s - slack_s || at_s > end_s + slack_s) return;
    at_s = std::clamp(at_s, begin_s, end_s);
  }
  const double from_left = column.value[row] + before * (at_s - begin_s);
  const double from_right = column.value[row + 1] + after * (at_s - end_s);
  corners.add(at_s, 0.5 * (from_left + from_right));
}

/// Adds the corners between two lines: one that ends with the row `end`, and the next one that
/// begins with the row `begin` and has at least three rows. Any lines between them have two rows.
void add_corners(const LinedColumn& column, std::size_t end, std::size_t begin, Readings& corners) {
  constexpr std::size_t kMaxRows = 15;
  if (begin == end) {
    corners.add(column.t_s[end], column.value[end]);
  } else if ((begin - end) % 2 == 1 && begin - end <= kMaxRows) {
    for (std::size_t row = end; row < begin; row += 2) add_corner_after(column, row, corners);
  }
}

}  // namespace

double off_chord(std::span<const double> t_s, std::span<const double> value, std::size_t row) {
  const double before_s = t_s[row] - t_s[row - 1];
  const double after_s = t_s[row + 1] - t_s[row];
  const double chord =
      (value[row - 1] * after_s + value[row + 1] * before_s) / (before_s + after_s);
  return std::abs(value[row] - chord);
}

LinedColumn lined_column(std::span<const double> t_s, std::span<const double> value,
                         double rounding) {
  LinedColumn column{
      t_s, value,   std::vector<double>(value.size(), 0.0), std::vector<bool>(value.size(), false),
      0.0, rounding};
  for (std::size_t i = 1; i + 1 < value.size(); ++i) {
    column.off_chord[i] = off_chord(t_s, value, i);
    column.is_flat[i] = value[i] == value[i - 1] && value[i] == value[i + 1];
  }
  constexpr double kSmall = 0.02;
  constexpr double kRounding = 1.01;  // e of three values that are each rounded by half a unit
  constexpr double kArithmetic = 1e-12;
  constexpr double kTimeRounding_s = 1e-6;
  const std::vector<double> deviations = column.deviations();
  if (!deviations.empty()) {
    const auto [least, most] = std::ranges::minmax(value);
    std::vector<double> slopes;
    for (std::size_t i = 0; i + 1 < value.size(); ++i) {
      slopes.push_back(std::abs(slope_from(column, i)));
    }
    column.tolerance = std::max({kSmall * quantile(deviations, 0.75), kRounding * rounding,
                                 kTimeRounding_s * quantile(std::move(slopes), 0.99),
                                 kArithmetic * std::max(std::abs(least), std::abs(most))});
  }
  return column;
}

bool has_lines(const LinedColumn& column) {
  constexpr std::size_t kMin = 30;
  const std::vector<double> deviations = column.deviations();
  if (deviations.size() < kMin) return false;
  std::vector<double> on_line;
  std::vector<double> others;
  double near = 0.0;  // rows between one and three tolerances
  for (const double deviation : deviations) {
    (deviation <= column.tolerance ? on_line : others).push_back(deviation);
    const bool is_near = deviation > column.tolerance && deviation <= 3.0 * column.tolerance;
    if (is_near) near += 1.0;
  }
  const double by_chance = 3.0 * near / 2.0;
  if (others.empty() || static_cast<double>(on_line.size()) <=
                            0.1 * static_cast<double>(deviations.size()) + by_chance) {
    return false;
  }
  // Interpolation leaves only rounding errors. The deviations of a smooth signal without noise have
  // all sizes.
  return median(std::move(others)) >= 3.0 * column.tolerance &&
         median(std::move(on_line)) <= std::max(column.rounding, 0.01 * column.tolerance);
}

Readings corners_of(const LinedColumn& column) {
  Readings corners{{column.t_s.front()}, {column.value.front()}};
  std::size_t last_end = 0;
  for (std::size_t i = 1; i + 1 < column.rows(); ++i) {
    if (!column.is_on_line(i)) continue;
    const std::size_t begin = i - 1;
    while (i + 2 < column.rows() && column.is_on_line(i + 1)) ++i;
    if (last_end > 0) add_corners(column, last_end, begin, corners);
    last_end = i + 1;
  }
  if (corners.t_s.back() < column.t_s.back()) {
    corners.add(column.t_s.back(), column.value.back());
  }
  return corners;
}

bool are_evenly_spaced(const LinedColumn& column, const Readings& corners) {
  constexpr std::size_t kMin = 20;
  constexpr double kMostlyEqual = 0.8;
  constexpr double kApart = 0.4;
  if (corners.t_s.size() < kMin) return false;
  const double usual_s = median_step_of(corners.t_s);
  const double row_s = median_step_of(column.t_s);
  double equal = 0.0;
  for (std::size_t i = 1; i < corners.t_s.size(); ++i) {
    const double gap_s = corners.t_s[i] - corners.t_s[i - 1];
    if (std::abs(gap_s - usual_s) < kApart * usual_s) equal += 1.0;
  }
  return equal >= kMostlyEqual * static_cast<double>(corners.t_s.size() - 1) &&
         usual_s >= 1.9 * row_s && usual_s <= 20.0 * row_s;
}

double value_at(const LinedColumn& column, double at_s, double previous_s, double next_s) {
  const std::span<const double> t_s = column.t_s;
  const auto after =
      static_cast<std::size_t>(std::lower_bound(t_s.begin(), t_s.end(), at_s) - t_s.begin());
  if (after >= t_s.size()) return column.value.back();
  if (after == 0 || t_s[after] == at_s) return column.value[after];
  double sum = 0.0;
  int lines = 0;
  if (after >= 2 && t_s[after - 2] >= previous_s) {
    sum += column.value[after - 1] + slope_from(column, after - 2) * (at_s - t_s[after - 1]);
    ++lines;
  }
  if (after + 1 < t_s.size() && t_s[after + 1] <= next_s) {
    sum += column.value[after] + slope_from(column, after) * (at_s - t_s[after]);
    ++lines;
  }
  if (lines > 0) return sum / lines;
  return column.value[after - 1] + slope_from(column, after - 1) * (at_s - t_s[after - 1]);
}

}  // namespace awmr
