#include "awmr/report/figures/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace awmr {
namespace {

/// A step of m 10^power, m = 1, 2 or 5.
struct TickStep {
  int mantissa = 1;
  int power = 0;

  double value() const { return mantissa * std::pow(10.0, power); }
};

/// The smallest step with at most `most` multiples in the range.
TickStep step_for(Interval range, int most) {
  const auto count = [&](const TickStep& step) {
    const double h = step.value();
    return std::floor(range.hi / h) - std::ceil(range.lo / h) + 1.0;
  };
  // Starts one decade lower, so that rounding of the logarithm does not matter.
  const int power = static_cast<int>(std::floor(std::log10((range.hi - range.lo) / most))) - 1;
  for (int i = power;; ++i) {
    for (const int mantissa : {1, 2, 5}) {
      const TickStep step{mantissa, i};
      if (count(step) <= most) return step;
    }
  }
}

/// Numbers between 0.001 and 99999 need no exponent.
int exponent_for(Interval range) {
  const double largest = std::max(std::abs(range.lo), std::abs(range.hi));
  const int magnitude = static_cast<int>(std::floor(std::log10(largest)));
  if (magnitude >= -3 && magnitude <= 4) return 0;
  return 3 * static_cast<int>(std::floor(magnitude / 3.0));
}

std::string tick_text(double scaled, int decimals) {
  std::string text = fmt::format("{:.{}f}", scaled, decimals);
  if (!text.starts_with('-')) return text;
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return (is_zero ? "" : "\u2212") + text.substr(1);
}

}  // namespace

Ticks ticks_in(Interval range, int most) {
  const TickStep step = step_for(range, most);
  Ticks ticks{.exponent = exponent_for(range)};
  const int decimals = std::max(0, ticks.exponent - step.power);
  const double h = step.value();
  for (double k = std::ceil(range.lo / h); k <= std::floor(range.hi / h); k += 1.0) {
    const double scaled = k * step.mantissa * std::pow(10.0, step.power - ticks.exponent);
    ticks.list.push_back({k * h, tick_text(scaled, decimals)});
  }
  return ticks;
}

}  // namespace awmr
