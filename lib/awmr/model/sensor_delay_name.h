/// Name of a sensor's estimated delay, in /estimates.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kSensorDelayPrefix = "delay.";  ///< + the channel's column

}  // namespace awmr
