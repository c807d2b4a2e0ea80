/// The one table of the identified quantities: name, symbol, unit, bounds, place in model.json.
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
};
inline constexpr std::size_t kParameterCount = 13;

struct ParameterInfo {
  ParameterId id;
  std::string_view name;     ///< "surge.alpha", as in /covariance and --fit
  std::string_view pointer;  ///< "/surge/alpha" in model.json
  std::string_view symbol;   ///< "a1"
  std::string_view unit;     ///< "1" where dimensionless
  std::string_view meaning;
  std::string_view trial;  ///< the trial that shows it, in words for a refusal
  bool term = false;       ///< 0 and absent from model.json unless the family has it
};

/// What a fit of logs can estimate beside the parameters; in /estimates only.
inline constexpr std::string_view kInputDelayName = "input_delay_s";
inline constexpr std::string_view kBiasPrefix = "bias.";  ///< + the channel's column
/// What a coast-down shows without a surge trial: m'/a1, in s (m/s)^(b1 - 1).
inline constexpr std::string_view kMassOverSurgeName = "mass_norm/surge.alpha";

/// In the order of ParameterId.
const std::array<ParameterInfo, kParameterCount>& parameter_table();
const ParameterInfo& info(ParameterId id);
std::optional<ParameterId> parameter_by_name(std::string_view name);

}  // namespace awmr
