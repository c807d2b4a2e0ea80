/// Guesses the unit of wheel forces that exceed the vehicle's limit F'max (`wheel_force`), by the
/// rules of CHECKS.md, "Unit of the forces". Private to trials/.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/model/vehicle.h"
#include "unit_fix.h"

namespace awmr {

/// A force of up to this factor times the limit F'max counts as within the limit, because the
/// excess may be due to rounding.
inline constexpr double kForceRounding = 1.01;

/// F'max: the largest magnitude of the force of one wheel, of either sign.
double largest_wheel_force(const Vehicle& vehicle);

/// Range of the pulse lengths of a servo or a motor driver, us.
inline constexpr Interval kPulse_us{900.0, 2200.0};

/// Range of the forces of one wheel, in the unit of the file.
struct ForceSpan {
  double least = 0.0;    ///< smallest value, with its sign
  double largest = 0.0;  ///< largest magnitude
};

/// True if the largest magnitude is at most 1 (plus 0.5 %). The values can then be F', even if they
/// exceed the vehicle's limit F'max.
bool is_share_of_f_max(const ForceSpan& span);
/// Range that covers both ranges.
ForceSpan joined(const ForceSpan& a, const ForceSpan& b);

/// A possible unit. F' = factor times the value in the file, plus offset.
struct ForceUnit {
  std::string_view words;  ///< name of the unit: "8-bit PWM counts"
  /// 0: unknown, as for newtons; `words` then names the force to divide by.
  double factor = 0.0;
  double offset = 0.0;
};

/// Possible units of forces beyond F'max.
struct ForceUnits {
  /// At least one, most likely first; exactly one if the unit is certain.
  std::vector<ForceUnit> units;
  /// Advice to change vehicle.json instead of the unit; may be empty.
  std::string remedy = {};
};
/// Returns the possible units of forces with this range. Precondition: span.largest > F'max.
ForceUnits force_units(const ForceSpan& span, const Vehicle& vehicle);

/// Text for messages: "the forces look like percent or 8-bit PWM counts"; "F' can be up to 1" if
/// vehicle.json may have to be changed (`units.remedy`).
std::string words_of(const ForceUnits& units);

/// Column mappings that convert `column`, the force of one wheel, to F': one for each possible unit
/// with a known factor.
std::vector<UnitFix> force_unit_fixes(const ForceUnits& units, std::string_view column);

/// Possible units of a column tau_speed with values above n F'max (n: number of driven wheels), and
/// the mappings that convert it to n F'. The column may contain the force of one wheel or the sum
/// of n wheels, so each unit can have two mappings.
struct ThrustUnits {
  ForceUnits units;
  std::vector<UnitFix> unit_fixes;
};
/// Returns the possible units of tau_speed. `thrust`: range of the column. `wheels`: range of the
/// wheel forces in the other tables, if they exceed F'max; these forces then decide the unit.
ThrustUnits thrust_units(const ForceSpan& thrust, const std::optional<ForceSpan>& wheels,
                         const Vehicle& vehicle);

/// Advice for messages: `units.remedy`, then "map it with --column 'A' (percent) or with ...".
/// Without a full stop, so that the caller can append ", or accept it with --as-is".
std::string remedy_of(const ForceUnits& units, std::span<const UnitFix> unit_fixes,
                      std::span<const ColumnMapping> mappings);

}  // namespace awmr
