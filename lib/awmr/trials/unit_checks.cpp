#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "awmr/core/option_text.h"
#include "awmr/trials/log_evidence.h"
#include "force_units.h"
#include "motion_units.h"
#include "steering_units.h"

namespace awmr {
namespace {

/// A unit that t_s may have by mistake.
struct TimeUnit {
  double factor;  ///< ratio of the row spacing to the sample time if t_s has this unit
  std::string_view words;
};

/// Builds the contradiction which states that t_s is probably in `unit`, not in seconds.
Contradiction time_in(const TimeUnit& unit, const Evidence& evidence) {
  const double step_s = evidence.log.median_step_s();
  const double sample_time_s = evidence.vehicle.sample_time_s;
  return {"t_s",
          fmt::format("rows are {:.4g} apart in t_s, {:.3g} times sample_time_s = {:g} s: the time "
                      "looks like {}",
                      step_s, step_s / sample_time_s, sample_time_s, unit.words),
          scaled_mapping(evidence, "t_s", 1.0 / unit.factor)};
}

std::optional<Contradiction> check_time(const Evidence& evidence) {
  static constexpr std::array<TimeUnit, 3> kFactors{
      {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}}};
  const double step_s = evidence.log.median_step_s();
  const double ratio = step_s / evidence.vehicle.sample_time_s;
  for (const TimeUnit& unit : kFactors) {
    if (ratio < 0.3 * unit.factor || ratio > 30.0 * unit.factor) continue;
    return time_in(unit, evidence);
  }
  // A row spacing below 1 ms and below a twentieth of the sample time is too short to be in
  // seconds.
  constexpr double kFastest_s = 1e-3;
  constexpr double kOften = 0.05;
  if (step_s >= kFastest_s || ratio >= kOften) return std::nullopt;
  static constexpr std::array<TimeUnit, 4> kLong{{{1.0 / 60.0, "minutes"},
                                                  {1e-3, "thousands of seconds"},
                                                  {1.0 / 3600.0, "hours"},
                                                  {1.0 / 86400.0, "days"}}};
  const TimeUnit& nearest = *std::ranges::min_element(
      kLong, {}, [&](const TimeUnit& one) { return std::abs(std::log(ratio / one.factor)); });
  return time_in(nearest, evidence);
}

std::optional<Contradiction> check_force(const Evidence& evidence, std::string_view column,
                                         const std::vector<double>& values,
                                         const ForceSpan& of_both) {
  const Interval& limit = evidence.vehicle.wheel_force;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double above = limit.hi * kForceRounding;
  const double below = limit.lo < 0.0 ? limit.lo * kForceRounding : -0.01 * limit.hi;
  if (*most <= above && *least >= below) return std::nullopt;
  const double worst = *most > above ? *most : *least;
  const std::string beyond = fmt::format(
      "reaches {:.4g}, beyond wheel_force [{:g}, {:g}] of the "
      "vehicle: ",
      worst, limit.lo, limit.hi);
  if (of_both.largest <= std::max(limit.hi, -limit.lo) * kForceRounding) {
    // The vehicle allows this magnitude in the other direction, so only the sign is wrong, not the
    // unit.
    return Contradiction{
        std::string(column), beyond + "the vehicle permits it only in the other direction", "",
        fmt::format("widen wheel_force in vehicle.json to {:.4g}, or correct the signs", worst)};
  }
  const ForceUnits units = force_units(of_both, evidence.vehicle);
  const std::vector<UnitFix> unit_fixes = force_unit_fixes(units, column);
  const std::string likeliest =
      unit_fixes.empty()
          ? ""
          : scaled_mapping(evidence, column, unit_fixes[0].factor, unit_fixes[0].offset);
  std::string words = beyond + words_of(units);
  if (unit_fixes.empty()) {
    words += fmt::format(", or like commands before the controller limits them (map them with {})",
                         option_text(fmt::format("column '{0}=min({1:g}, max({2:g}, {0}))'", column,
                                                 limit.hi, limit.lo)));
  }
  return Contradiction{std::string(column), words, likeliest,
                       remedy_of(units, unit_fixes, evidence.mappings)};
}

/// Range of the forces of both sides. Zeros are left out, because 0 in a column of servo pulses
/// means that there was no reading.
ForceSpan force_span(const DrivingLog& log) {
  ForceSpan span{std::numeric_limits<double>::infinity(), 0.0};
  for (const auto* values : {&log.force_left, &log.force_right}) {
    for (const double value : *values) {
      if (value != 0.0) span = joined(span, {value, std::abs(value)});
    }
  }
  return span;
}

std::vector<Contradiction> check_forces(const Evidence& evidence) {
  const ForceSpan span = force_span(evidence.log);
  std::vector<Contradiction> found;
  for (const auto& [column, values] : {std::pair{"force_left", &evidence.log.force_left},
                                       std::pair{"force_right", &evidence.log.force_right}}) {
    if (auto one = check_force(evidence, column, *values, span)) found.push_back(*one);
  }
  return found;
}

}  // namespace

std::vector<Contradiction> unit_contradictions(const Evidence& evidence) {
  std::vector<Contradiction> found = check_forces(evidence);
  // If the unit of t_s is wrong, the windows are not one second long, and the units of the motion
  // cannot be checked.
  if (auto time = check_time(evidence)) {
    found.insert(found.begin(), *time);
    return found;
  }
  if (const auto steering = steering_unit_contradiction(evidence)) found.push_back(*steering);
  const std::vector<Contradiction> motion = motion_unit_contradictions(evidence);
  found.insert(found.end(), motion.begin(), motion.end());
  return found;
}

}  // namespace awmr
