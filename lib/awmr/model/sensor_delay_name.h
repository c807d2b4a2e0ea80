/// How the delay of a sensor, and the time constant of its filter, are called where it is estimated, in /estimates.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kSensorDelayPrefix = "delay.";  ///< + the channel's column
inline constexpr std::string_view kSensorLagPrefix = "lag.";      ///< + the channel's column

}  // namespace awmr
