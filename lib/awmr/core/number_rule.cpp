#include "awmr/core/number_rule.h"

#include <fmt/format.h>

#include "awmr/core/csv.h"

namespace awmr {

bool allows(const NumberRule& rule, double value) {
  return (rule.min_excluded ? value > rule.min : value >= rule.min) &&
         (rule.max_excluded ? value < rule.max : value <= rule.max);
}

bool allows(const NumberRule& rule, const Interval& interval) {
  return interval.lo <= interval.hi && allows(rule, interval.lo) && allows(rule, interval.hi);
}

std::string describe(const NumberRule& rule) {
  std::string text = "a number";
  if (rule.min > kAnyNumber.min) {
    text +=
        fmt::format(" {} {}", rule.min_excluded ? "above" : "at least", format_number(rule.min));
  }
  if (rule.max < kAnyNumber.max) {
    text += fmt::format("{} {} {}", rule.min > kAnyNumber.min ? " and" : "",
                        rule.max_excluded ? "below" : "at most", format_number(rule.max));
  }
  return text;
}

}  // namespace awmr
