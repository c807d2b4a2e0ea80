#include "interpolated_readings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/trials/checks/channel_quality.h"
#include "even_times.h"

namespace awmr {
namespace {

std::vector<double> every(std::size_t stride, std::span<const double> values) {
  std::vector<double> some;
  for (std::size_t i = 0; i < values.size(); i += stride) some.push_back(values[i]);
  return some;
}

/// The times t_0 + n h of the corners if these are evenly spaced: most of them must be within 20 %
/// of a row of these times. (The time of a corner is uncertain if two lines have about the same
/// slope.)
std::optional<EvenTimes> even_times_of(const LinedColumn& column, const Readings& corners) {
  constexpr double kMaxOff = 0.2;
  const double row_s = median_step_of(column.t_s);
  const double usual_s = median_step_of(corners.t_s);
  std::vector<double> numbers{0.0};
  for (std::size_t k = 1; k < corners.t_s.size(); ++k) {
    numbers.push_back(numbers.back() + std::round((corners.t_s[k] - corners.t_s[k - 1]) / usual_s));
  }
  const auto off_s = [&](const EvenTimes& even, std::size_t k) {
    return std::abs(corners.t_s[k] - even.at(numbers[k]));
  };
  // Fit all corners, then only those near the fit before.
  EvenTimes even = even_times(corners.t_s, numbers);
  for (const double most_off_s : {0.5 * row_s, 0.25 * row_s}) {
    std::vector<std::size_t> near;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (off_s(even, k) <= most_off_s) near.push_back(k);
    }
    if (near.size() < numbers.size() / 2) return std::nullopt;
    even = even_times(picked(corners.t_s, near), picked(numbers, near));
  }
  std::vector<double> all_off_s;
  for (std::size_t k = 0; k < numbers.size(); ++k) all_off_s.push_back(off_s(even, k));
  if (!(even.step_s > 0.0) || median(std::move(all_off_s)) > kMaxOff * row_s) return std::nullopt;
  return even;
}

/// Readings at all even times that are between two rows. Row steps longer than h are gaps without
/// readings, so there are at most as many readings as rows.
Readings readings_at(const LinedColumn& column, const EvenTimes& even) {
  const double slack_s = 1e-3 * median_step_of(column.t_s);
  Readings readings;
  for (std::size_t row = 1; row < column.rows(); ++row) {
    const double begin_s = column.t_s[row - 1];
    const double end_s = column.t_s[row];
    const double at_s = even.at(std::ceil((begin_s - even.first_s) / even.step_s - 1e-9));
    const bool is_gap = end_s - begin_s > even.step_s;
    const bool is_new = readings.t_s.empty() || at_s - readings.t_s.back() > 0.5 * even.step_s;
    if (is_gap || at_s > end_s + slack_s || !is_new) continue;
    const double reading_s = std::min(at_s, end_s);
    readings.add(reading_s, value_at(column, reading_s, at_s - even.step_s - slack_s,
                                     at_s + even.step_s + slack_s));
  }
  return readings;
}

/// Leaves out the readings on a slanted line that spans more than three time spans: the program has
/// bridged a gap in the readings. (A line of constant value is a rest.)
Readings without_bridged_gaps(const Readings& all, double tolerance) {
  constexpr std::size_t kMaxSpans = 3;
  const auto is_on_line = [&](std::size_t k) {
    return off_chord(all.t_s, all.value, k) <= 2.0 * tolerance;
  };
  Readings kept;
  const auto keep = [&](std::size_t k) { kept.add(all.t_s[k], all.value[k]); };
  for (std::size_t k = 0; k < all.t_s.size();) {
    keep(k);
    std::size_t end = k + 1;  // last reading of the line that begins with k
    while (end + 1 < all.t_s.size() && is_on_line(end)) ++end;
    if (end >= all.t_s.size()) break;
    // The ends of the line, where two lines cross, are less exact than the readings between them.
    const bool is_gap =
        end - k > kMaxSpans && std::abs(all.value[end - 1] - all.value[k + 1]) > 2.0 * tolerance;
    for (std::size_t i = k + 1; i < end && !is_gap; ++i) keep(i);
    k = end;
  }
  return kept;
}

/// True if nearly all rows of a column are on the lines between the readings, and if readings at
/// their usual time spans cover nearly all of its time, without gaps in the file. Otherwise, the
/// column has lines for another reason, or only a part of it is interpolated.
bool describe(const Readings& readings, const LinedColumn& column) {
  constexpr double kNearlyAll = 0.95;
  constexpr double kMinCovered = 0.8;
  if (readings.t_s.size() < 2) return false;
  const double usual_s = median_step_of(readings.t_s);
  const double near = 2.0 * std::max(column.rounding, column.tolerance);
  double rows = 0.0;
  double on_line = 0.0;
  double duration_s = 0.0;
  std::size_t next = 1;
  for (std::size_t row = 1; row < column.rows(); ++row) {
    const double t_s = column.t_s[row];
    if (t_s - column.t_s[row - 1] <= usual_s) duration_s += t_s - column.t_s[row - 1];
    while (next + 1 < readings.t_s.size() && readings.t_s[next] < t_s) ++next;
    if (t_s < readings.t_s[next - 1] || t_s > readings.t_s[next]) continue;
    const double share =
        (t_s - readings.t_s[next - 1]) / (readings.t_s[next] - readings.t_s[next - 1]);
    const double line =
        readings.value[next - 1] + share * (readings.value[next] - readings.value[next - 1]);
    rows += 1.0;
    if (std::abs(column.value[row] - line) <= near) on_line += 1.0;
  }
  const double covered_s = static_cast<double>(readings.t_s.size()) * usual_s;
  return on_line >= kNearlyAll * rows && covered_s >= kMinCovered * duration_s;
}

/// value_at() for the times of all readings. `slack_s`: tolerance of these times.
Readings values_at(const LinedColumn& column, std::span<const double> readings_s, double slack_s) {
  Readings readings;
  for (std::size_t k = 0; k < readings_s.size(); ++k) {
    const double previous_s = k > 0 ? readings_s[k - 1] - slack_s : column.t_s.front();
    const double next_s =
        k + 1 < readings_s.size() ? readings_s[k + 1] + slack_s : column.t_s.back();
    readings.add(readings_s[k], value_at(column, readings_s[k], previous_s, next_s));
  }
  return readings;
}

}  // namespace

std::optional<Readings> interpolated_readings(std::span<const double> t_s,
                                              std::span<const double> value, double rounding) {
  constexpr std::size_t kMinRows = 50;
  // Rounding hides corners of short lines. In a column with fewer rows, the corners are sharper.
  for (const std::size_t stride : {1, 2, 4}) {
    const std::vector<double> some_s = every(stride, t_s);
    const std::vector<double> some = every(stride, value);
    if (some.size() < kMinRows) break;
    const LinedColumn column = lined_column(some_s, some, rounding);
    if (!has_lines(column)) continue;
    const Readings corners = corners_of(column);
    if (!are_evenly_spaced(column, corners)) continue;
    const LinedColumn all = lined_column(t_s, value, rounding);
    if (const auto even = even_times_of(column, corners)) {
      const Readings readings = without_bridged_gaps(readings_at(all, *even), column.tolerance);
      if (describe(readings, all)) return readings;
    }
    if (describe(corners, all)) return corners;
  }
  return std::nullopt;
}

std::optional<Readings> interpolated_between(std::span<const double> readings_s,
                                             std::span<const double> t_s,
                                             std::span<const double> value, double rounding) {
  constexpr double kNearlyAll = 0.9;
  constexpr double kMinCorners = 0.7;  // of the readings
  constexpr double kMinCount = 5.0;
  if (t_s.size() < 3 || readings_s.empty()) return std::nullopt;
  const double slack_s = 1e-3 * median_step_of(t_s);
  const double longest_s = 1.5 * median_step_of(readings_s);
  const LinedColumn column = lined_column(t_s, value, rounding);
  double inside = 0.0;  // rows whose neighbours are between the same two readings
  double on_line = 0.0;
  double spanning = 0.0;  // other rows
  double corners = 0.0;
  std::size_t next = 0;  // first reading later than the row before
  for (std::size_t i = 1; i + 1 < column.rows(); ++i) {
    while (next < readings_s.size() && readings_s[next] <= t_s[i - 1] + slack_s) ++next;
    if (column.is_flat[i]) continue;
    if (next < readings_s.size() && readings_s[next] < t_s[i + 1] - slack_s) {
      spanning += 1.0;
      if (!column.is_on_line(i)) corners += 1.0;
      continue;
    }
    inside += 1.0;
    if (column.is_on_line(i)) {
      on_line += 1.0;
    } else if (next > 0 && next < readings_s.size() &&
               readings_s[next] - readings_s[next - 1] > longest_s) {
      return std::nullopt;  // a change in a gap of the other column's readings
    }
  }
  const bool is_slower = corners < kMinCorners * spanning;  // it has fewer readings
  if (inside < kMinCount || corners < kMinCount || is_slower || on_line < kNearlyAll * inside) {
    return std::nullopt;
  }
  return values_at(column, readings_s, slack_s);
}

std::optional<Readings> changing_at(std::span<const double> readings_s, std::span<const double> t_s,
                                    std::span<const double> value) {
  constexpr int kMinChanges = 10;
  if (t_s.size() < 2 || readings_s.empty()) return std::nullopt;
  const double slack_s = 1e-3 * median_step_of(t_s);
  Readings readings;
  int changes = 0;
  for (std::size_t row = 1, next = 0; row < value.size(); ++row) {
    const std::size_t before = next;
    while (next < readings_s.size() && readings_s[next] <= t_s[row] + slack_s) {
      const double at_s = readings_s[next++];
      readings.add(at_s, value[at_s > t_s[row - 1] + slack_s ? row : row - 1]);
    }
    if (value[row] == value[row - 1]) continue;
    if (next == before) return std::nullopt;  // the change is not in the first row after a reading
    ++changes;
  }
  return changes < kMinChanges ? std::nullopt : std::optional(std::move(readings));
}

double smallest_step(std::span<const double> value) {
  constexpr double kArithmetic = 1e-12;
  std::vector<double> sorted(value.begin(), value.end());
  std::ranges::sort(sorted);
  const double largest = largest_size(value);
  double smallest = 0.0;
  const auto consider = [&](double step) {
    if (step > kArithmetic * largest && (smallest == 0.0 || step < smallest)) smallest = step;
  };
  for (std::size_t i = 1; i < sorted.size(); ++i) consider(sorted[i] - sorted[i - 1]);
  for (std::size_t i = 2; i < value.size(); ++i) {
    consider(std::abs(value[i] - 2.0 * value[i - 1] + value[i - 2]));
  }
  return smallest;
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
