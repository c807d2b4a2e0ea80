/// What forces beyond a vehicle's limit most likely are. Private to this folder.
///
///     up to 1                               F' itself: the vehicle's wheel_force is too narrow
///     900 to 2200, none below               microseconds of a servo pulse: F' = (us - 1500)/500
///     100, 255, 1000, 1023, 4095, to 0.5 %  percent, PWM counts, per mille: driven at full power
///     20 to 100 % of one of these           perhaps that: all such are named
///     n F/m of 0.1 to 30 m/s^2              perhaps newtons: what motors do to a mass
///     2 to 60                               perhaps volts
///
/// Only what is driven at full power tells its unit for certain, so that the largest force of all of a
/// vehicle's tables decides for each of their columns.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/model/vehicle.h"
#include "mending.h"

namespace awmr {

/// Beyond a limit by rounding alone is within it.
inline constexpr double kForceRounding = 1.01;

/// The forces of single wheels, as files have them.
struct ForceSpan {
  double least = 0.0;    ///< with its sign
  double largest = 0.0;  ///< of the magnitudes
};

/// They are F', if not the vehicle's: at most 1.
bool is_share_of_f_max(const ForceSpan& span);
/// Both spans' forces.
ForceSpan joined(const ForceSpan& a, const ForceSpan& b);

/// What the values may be. F' = factor value + offset.
struct ForceUnit {
  std::string_view words;  ///< "8-bit PWM counts"
  double factor = 0.0;     ///< 0: not known, as of newtons; the words say what to divide by
  double offset = 0.0;
};

/// What forces beyond F'max are, the likeliest first. Precondition: span.largest > F'max.
struct ForceUnits {
  std::vector<ForceUnit> units;  ///< not empty; one where there is no doubt
  std::string remedy = {};       ///< beside a mapping: what to change in vehicle.json; may be empty

  bool is_clear() const { return units.size() == 1; }
};
ForceUnits force_units(const ForceSpan& span, const Vehicle& vehicle);

/// "the forces look like percent or 8-bit PWM counts".
std::string words_of(const ForceUnits& units);

/// What makes a column of single wheels' forces F'; none for a unit whose factor is not known.
std::vector<Mending> force_mendings(const ForceUnits& units, std::string_view column);

/// What tau_speed beyond n F'max is, and what makes it n F'. Of a column that people fill with one wheel's
/// force or with the sum of n, each reading that is possible is named.
struct ThrustUnits {
  ForceUnits units;
  std::vector<Mending> mendings;
};
/// `thrust`: of the column tau_speed. `wheels`: of the other tables' forces beyond F'max, which then tell
/// the unit.
ThrustUnits thrust_units(const ForceSpan& thrust, const std::optional<ForceSpan>& wheels,
                         const Vehicle& vehicle);

/// "map it by --column 'A' (percent) or by ...", with the remedy beside it; ends without a stop, for ", or
/// take it as it is" to follow.
std::string remedy_of(const ForceUnits& units, std::span<const Mending> mendings,
                      std::span<const ColumnMapping> mappings);

}  // namespace awmr
