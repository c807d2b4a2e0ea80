#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/report/figures/page.h"

namespace awmr {
namespace {

/// A relative range below this is rounding and is drawn as a constant.
constexpr double kLeastRelativeSpan = 1e-6;
constexpr double kLargestNumber = 1e100;
constexpr double kLeastSpan = 1e-100;

/// Minimum and maximum of the values added.
struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(const std::vector<double>& values) {
    for (const double x : values) take(x);
  }
  void take(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  /// The range with this fraction of it as margin on both sides; around a constant, a tenth of it;
  /// around 0, one.
  Interval with_room(double share) const {
    if (low > high) return {0.0, 1.0};
    const double size = std::max(std::abs(low), std::abs(high));
    double span = high - low;
    double room = share * span;
    if (!(span > std::max(kLeastSpan, kLeastRelativeSpan * size))) {
      room = size > kLeastSpan ? 0.1 * size : 1.0;
    }
    return {low - room, high + room};
  }
};

}  // namespace

Status check_numbers(const Figure& figure) {
  const auto drawable = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(),
                       [](double x) { return std::abs(x) <= kLargestNumber; });
  };
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      if (drawable(s.x) && drawable(s.y) && drawable(s.low) && drawable(s.high)) continue;
      return input_error("", fmt::format("the figure {} cannot be drawn: \"{}\" has a number that "
                                         "is not finite or beyond 1e100",
                                         figure.name, s.name));
    }
  }
  return {};
}

Interval x_range(const Figure& figure) {
  Span span;
  for (const Panel& panel : figure.panels) {
    for (const Series& s : panel.series) {
      span.take(s.x);
      if (s.shape != SeriesShape::kRanges) continue;
      span.take(s.low);
      span.take(s.high);
    }
  }
  for (const FigureCircle& c : figure.circles) {
    span.take(c.x - c.radius);
    span.take(c.x + c.radius);
  }
  if (figure.x.zero) span.take(0.0);
  return span.with_room(0.02);
}

Interval y_range(const Figure& figure, const Panel& panel) {
  const auto rows = static_cast<double>(panel.y.rows.size());
  if (rows > 0.0) return {0.4 - rows, 0.6};  // row i is at -i, the first on top
  Span span;
  for (const Series& s : panel.series) {
    span.take(s.y);
    span.take(s.low);
    span.take(s.high);
  }
  for (const FigureCircle& c : figure.circles) {
    span.take(c.y - c.radius);
    span.take(c.y + c.radius);
  }
  if (panel.y.zero) span.take(0.0);
  return span.with_room(0.05);
}

}  // namespace awmr
