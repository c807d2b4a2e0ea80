/// The three modes of yaw control. Freestanding C++14.
#pragma once

namespace awmr {

/// Modes of yaw control, by the actuators that make the yaw moment.
enum class YawMode {
  kDifferential,  ///< difference of right and left wheel forces, wheels straight
  kSteering,      ///< steered front wheels, right and left wheel forces equal
  kCombined,      ///< half of the moment by wheel forces, half by steering
};

constexpr int kYawModeCount = 3;  ///< number of modes, numbered from 0

}  // namespace awmr
