/// Likely units of forces beyond a vehicle's limit. Private to this folder.
///
///     up to 1                               F' itself: the vehicle's wheel_force is too narrow
///     900 to 2200, none below               microseconds of a servo pulse: F' = (us - 1500)/500
///     100, 255, 1000, 1023, 4095, to 0.5 %  percent, PWM counts, per mille at full power
///     20 to 100 % of one of these           possibly that scale: all such scales are listed
///     n F/m of 0.1 to 30 m/s^2              possibly newtons: a plausible acceleration
///     2 to 60                               possibly volts
///
/// Only full power identifies the unit for certain. The largest force in all tables of a vehicle
/// therefore decides the unit of every column.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/model/vehicle.h"
#include "unit_fix.h"

namespace awmr {

/// Forces beyond a limit only by rounding are within it.
inline constexpr double kForceRounding = 1.01;

/// Range of a servo's or a motor driver's pulses, us.
inline constexpr Interval kPulse_us{900.0, 2200.0};

/// Range of single-wheel forces, as in files.
struct ForceSpan {
  double least = 0.0;    ///< signed
  double largest = 0.0;  ///< of the magnitudes
};

/// True for values that can be F', even if beyond the vehicle's limit: at most 1.
bool is_share_of_f_max(const ForceSpan& span);
/// Range that covers both.
ForceSpan joined(const ForceSpan& a, const ForceSpan& b);

/// A possible unit of the values. F' = factor value + offset.
struct ForceUnit {
  std::string_view words;  ///< "8-bit PWM counts"
  double factor = 0.0;     ///< 0: unknown, as for newtons; `words` says what to divide by
  double offset = 0.0;
};

/// Possible units of forces beyond F'max, the most likely first. Precondition: span.largest >
/// F'max.
struct ForceUnits {
  std::vector<ForceUnit> units;  ///< not empty; one if certain
  std::string remedy = {};       ///< change of vehicle.json, in addition to a mapping; may be empty

  bool is_clear() const { return units.size() == 1; }
};
ForceUnits force_units(const ForceSpan& span, const Vehicle& vehicle);

/// "the forces look like percent or 8-bit PWM counts".
std::string words_of(const ForceUnits& units);

/// Mappings that convert a column of single-wheel forces to F'; none for a unit with unknown
/// factor.
std::vector<UnitFix> force_unit_fixes(const ForceUnits& units, std::string_view column);

/// Possible units of a tau_speed beyond n F'max, and the mappings to n F'. A column may contain one
/// wheel's force or the sum of n, so each possible reading is listed.
struct ThrustUnits {
  ForceUnits units;
  std::vector<UnitFix> unit_fixes;
};
/// `thrust`: range of the column tau_speed. `wheels`: range of the other tables' forces beyond
/// F'max, which then decides the unit.
ThrustUnits thrust_units(const ForceSpan& thrust, const std::optional<ForceSpan>& wheels,
                         const Vehicle& vehicle);

/// "map it by --column 'A' (percent) or by ...", with the remedy. Ends without a full stop, so that
/// ", or take it as it is" can follow.
std::string remedy_of(const ForceUnits& units, std::span<const UnitFix> unit_fixes,
                      std::span<const ColumnMapping> mappings);

}  // namespace awmr
