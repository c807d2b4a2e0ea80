/// How the delay of a sensor is called where it is estimated, in /estimates.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kSensorDelayPrefix = "delay.";  ///< + the channel's column

}  // namespace awmr
