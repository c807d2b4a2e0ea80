#include "force_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "awmr/core/text.h"
#include "awmr/model/plausibility.h"

namespace awmr {
namespace {

/// A scale of the motor command.
struct FullScale {
  double end;  ///< value at full power
  std::string_view words;
};
constexpr std::array<FullScale, 5> kFullScales{{{100.0, "percent"},
                                                {255.0, "8-bit PWM counts"},
                                                {1000.0, "per mille"},
                                                {1023.0, "10-bit PWM counts"},
                                                {4095.0, "12-bit PWM counts"}}};
// A force counts as full power if it differs from full power by at most this fraction.
constexpr double kEndOfScale = 0.005;
// Assumption: the largest force in the trials of a vehicle is at least this fraction of full power.
// With a smaller fraction, more units (percent, PWM counts, ...) would be possible.
constexpr double kMinShare = 0.2;
// Forces of up to this factor times F'max count as multiples of a force that is a little smaller
// than F_max.
constexpr double kPlainlyBeyond = 1.05;

constexpr ForceUnit kMicroseconds{
    "microseconds of a servo pulse (F' = (us - 1500)/500 if 1500 is standstill and 2000 full "
    "power)",
    1.0 / 500.0, -3.0};
constexpr ForceUnit kNewtons{"newtons (to be divided by F_max, the largest force of one motor)"};
constexpr ForceUnit kVolts{"volts (to be divided by the voltage of full power)"};
constexpr ForceUnit kUnknownForce{
    "an unknown unit (F' is the force divided by F_max of one motor)"};
constexpr Interval kVoltRange{2.0, 60.0};
constexpr Interval kAcceleration_mps2{0.1, 30.0};

bool is_end_of_scale(double largest, double end) {
  return std::abs(largest / end - 1.0) <= kEndOfScale;
}

bool may_be_newtons(double largest, const Vehicle& vehicle) {
  const double pushed_mps2 = vehicle.driven_wheels() * largest / vehicle.mass_kg;
  return implausible_values(vehicle).empty() && kAcceleration_mps2.contains(pushed_mps2);
}

/// Returns the scales (percent, per mille, PWM counts) on which the largest force would be 20 to
/// 100 % of full power. If it is full power on one scale, within 0.5 %, returns only this scale.
std::vector<ForceUnit> scales_of(double largest) {
  std::vector<ForceUnit> found;
  for (const FullScale& scale : kFullScales) {
    const ForceUnit unit{scale.words, 1.0 / scale.end};
    if (is_end_of_scale(largest, scale.end)) return {unit};
    if (largest < scale.end && largest >= kMinShare * scale.end) found.push_back(unit);
  }
  return found;
}

bool is_full_power(double largest) {
  return std::ranges::any_of(
      kFullScales, [&](const FullScale& scale) { return is_end_of_scale(largest, scale.end); });
}

void add_unit(std::vector<ForceUnit>& units, const ForceUnit& unit) {
  const bool is_known =
      std::ranges::any_of(units, [&](const ForceUnit& one) { return one.words == unit.words; });
  if (!is_known) units.push_back(unit);
}

}  // namespace

double largest_wheel_force(const Vehicle& vehicle) {
  return std::max(vehicle.wheel_force.hi, -vehicle.wheel_force.lo);
}

bool is_share_of_f_max(const ForceSpan& span) { return span.largest <= 1.0 + kEndOfScale; }

ForceSpan joined(const ForceSpan& a, const ForceSpan& b) {
  return {std::min(a.least, b.least), std::max(a.largest, b.largest)};
}

ForceUnits force_units(const ForceSpan& span, const Vehicle& vehicle) {
  const double limit = largest_wheel_force(vehicle);
  if (is_share_of_f_max(span)) {
    return {{{"fractions of the vehicle's largest force", vehicle.wheel_force.hi}},
            fmt::format("raise wheel_force in vehicle.json to {:.4g} if the motors were driven "
                        "with this force; if the column has fractions of wheel_force",
                        std::min(1.0, span.largest))};
  }
  const ForceUnit over_smaller{
      "multiples of a force smaller than F_max, the largest force of one motor",
      limit / span.largest};
  if (span.largest <= kPlainlyBeyond * limit) return {{over_smaller}};
  std::vector<ForceUnit> units;
  const bool may_be_pulse = span.least >= kPulse_us.lo && span.largest <= kPulse_us.hi;
  if (may_be_pulse) units.push_back(kMicroseconds);
  for (const ForceUnit& scale : scales_of(span.largest)) units.push_back(scale);
  if (is_full_power(span.largest) && !may_be_pulse) return {units};
  if (kVoltRange.contains(span.largest)) units.push_back(kVolts);
  if (!may_be_pulse && may_be_newtons(span.largest, vehicle)) units.push_back(kNewtons);
  if (units.empty()) units.push_back(kUnknownForce);
  return {units};
}

std::string words_of(const ForceUnits& units) {
  if (!units.remedy.empty()) return "F' can be up to 1";
  const auto words = [](const ForceUnit& unit) { return unit.words; };
  return "the forces look like " + enumerated(units.units, words, " or ");
}

std::vector<UnitFix> force_unit_fixes(const ForceUnits& units, std::string_view column) {
  std::vector<UnitFix> unit_fixes;
  for (const ForceUnit& unit : units.units) {
    if (unit.factor == 0.0) continue;
    const std::string_view name = unit.words.substr(0, unit.words.find(" ("));
    unit_fixes.push_back({std::string(name), column, unit.factor, unit.offset});
  }
  return unit_fixes;
}

ThrustUnits thrust_units(const ForceSpan& thrust, const std::optional<ForceSpan>& wheels,
                         const Vehicle& vehicle) {
  const int n = vehicle.driven_wheels();
  const ForceSpan of_one{thrust.least / n, thrust.largest / n};
  // tau_speed is n F', the sum over n driven wheels. F' is at most 1, so a tau_speed of up to n can
  // be in the right unit, even if it exceeds the vehicle's limit n F'max.
  const bool is_sum = is_share_of_f_max(of_one);
  ForceUnits units;
  if (wheels && !is_sum) {
    units = force_units(*wheels, vehicle);
  } else if (is_sum || (is_full_power(of_one.largest) && !is_full_power(thrust.largest))) {
    units = force_units(of_one, vehicle);
  } else {
    units = force_units(thrust, vehicle);
    if (!is_full_power(thrust.largest)) {
      for (const ForceUnit& unit : force_units(of_one, vehicle).units) add_unit(units.units, unit);
    }
  }
  const Interval possible{wheels || is_sum ? 0.0 : kMinShare, 1.0 + kEndOfScale};
  ThrustUnits found{units, {}};
  for (const ForceUnit& unit : units.units) {
    if (unit.factor == 0.0) continue;
    const std::string name(unit.words.substr(0, unit.words.find(" (")));
    const bool as_one = possible.contains(unit.factor * thrust.largest + unit.offset);
    const bool as_sum = possible.contains(unit.factor * of_one.largest + unit.offset);
    if (as_one && !is_sum) {
      found.unit_fixes.push_back(
          {name + " of one wheel", "tau_speed", n * unit.factor, n * unit.offset});
    }
    if (as_sum) {
      found.unit_fixes.push_back({fmt::format("{}, the sum of {} wheels", name, n), "tau_speed",
                                  unit.factor, n * unit.offset});
    }
  }
  return found;
}

std::string remedy_of(const ForceUnits& units, std::span<const UnitFix> unit_fixes,
                      std::span<const ColumnMapping> mappings) {
  std::string mapped = mapped_by(unit_fixes, mappings, units.units.size() > 1);
  if (units.remedy.empty() || mapped.empty()) return mapped;
  return units.remedy + ", " + mapped;
}

}  // namespace awmr
