/// The one table of the identified quantities: name, symbol, unit, place in model.json.
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
  // Terms that only some families of resistance have; 0 in a power law.
  kSurgeCoulomb,
  kSurgeQuadratic,
  kYawCoulomb,
  kYawQuadratic,
  kWheelDeadZone,
  kBackEmf,  ///< of the motors; in no family: see README.md
};
inline constexpr std::size_t kParameterCount = 14;

/// What is known of a parameter before any trial.
struct ParameterInfo {
  ParameterId id;
  std::string_view name;     ///< "surge.alpha", as in /covariance and where a fit is asked for it
  std::string_view pointer;  ///< "/surge/alpha" in model.json
  std::string_view symbol;   ///< "a1"
  std::string_view unit;     ///< "1" where dimensionless
  std::string_view meaning;  ///< what it is, in words for messages
  std::string_view trial;    ///< the trial that shows it, in words for a refusal
  bool term = false;         ///< 0 and absent from model.json unless the vehicle has it
};

/// What a fit of logs can estimate beside the parameters; in /estimates only.
inline constexpr std::string_view kInputDelayName = "input_delay_s";
inline constexpr std::string_view kSteeringDelayName = "steering.delay_s";
inline constexpr std::string_view kMotorLagName = "motor.time_constant_s";
inline constexpr std::string_view kBiasPrefix = "bias.";  ///< + the channel's column
/// All that a coast-down shows without a surge trial: the ratio m'/a1, in s (m/s)^(b1 - 1).
inline constexpr std::string_view kMassOverSurgeName = "mass_norm/surge.alpha";

/// The table, in the order of ParameterId.
const std::array<ParameterInfo, kParameterCount>& parameter_table();
const ParameterInfo& info(ParameterId id);
/// None where no parameter has this name.
std::optional<ParameterId> parameter_by_name(std::string_view name);

}  // namespace awmr
