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
};
inline constexpr std::size_t kParameterCount = 8;

struct ParameterInfo {
  ParameterId id;
  std::string_view name;     ///< "surge.alpha", as in /covariance and --fit
  std::string_view pointer;  ///< "/surge/alpha" in model.json
  std::string_view symbol;   ///< "a1"
  std::string_view unit;     ///< "1" where dimensionless
  std::string_view meaning;
  std::string_view trial;    ///< the trial that shows it, in words for a refusal
};

/// In the order of ParameterId.
const std::array<ParameterInfo, kParameterCount>& parameter_table();
const ParameterInfo& info(ParameterId id);
std::optional<ParameterId> parameter_by_name(std::string_view name);

}  // namespace awmr
