/// Table of the parameters of the model: name, symbol, unit, key in model.json.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace awmr {

enum class ParameterId {
  kSurgeAlpha,
  kSurgeBeta,
  kYawAlpha,
  kYawBeta,
  kSwayAlpha,
  kMassNorm,
  kInertiaNorm,
  kSteeringTimeConstant,
  // Terms of only some families of resistance; 0 in a power law.
  kSurgeCoulomb,
  kSurgeQuadratic,
  kYawCoulomb,
  kYawQuadratic,
  kWheelDeadZone,
  kBackEmf,  ///< k_e of the motors, in no family; see VEHICLES.md
};
inline constexpr std::size_t kParameterCount = 14;

/// Static properties of a parameter.
struct ParameterInfo {
  ParameterId id;
  std::string_view name;     ///< "surge.alpha", as in /covariance and in options of a fit
  std::string_view pointer;  ///< "/surge/alpha" in model.json
  std::string_view symbol;   ///< "a1"
  std::string_view unit;     ///< "1" if dimensionless
  std::string_view meaning;  ///< description for messages
  std::string_view trial;    ///< the trial that identifies it, as text for messages
  /// True for an optional term. If it was neither fitted nor given, it is 0, and model.json does
  /// not contain it.
  bool term = false;
};

/// Names of quantities that a fit of logs can estimate in addition to the parameters. model.json
/// has them only in /estimates.
inline constexpr std::string_view kInputDelayName = "input_delay_s";
inline constexpr std::string_view kSteeringDelayName = "steering.delay_s";
inline constexpr std::string_view kMotorLagName = "motor.time_constant_s";
inline constexpr std::string_view kBiasPrefix = "bias.";  ///< followed by the channel's column name
/// Name of the ratio m'/a1 (mass over surge coefficient), in s (m/s)^(b1 - 1). If there is no surge
/// trial, a coast-down determines only such ratios: m'/a1 and, if the resistance has a Coulomb or a
/// quadratic term, the coefficient of this term over a1 (ratio_names.h). If the resistance has an
/// exponent b1, the coast-down determines b1 as well.
inline constexpr std::string_view kMassOverSurgeName = "mass_norm/surge.alpha";

/// The table, in the order of ParameterId.
const std::array<ParameterInfo, kParameterCount>& parameter_table();
const ParameterInfo& info(ParameterId id);
/// The parameter with this name ("surge.alpha"); absent if no parameter has it.
std::optional<ParameterId> parameter_by_name(std::string_view name);

}  // namespace awmr
