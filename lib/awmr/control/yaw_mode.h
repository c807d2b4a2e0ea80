/// How each mode of yaw control (model/yaw_mode.h) distributes the yaw moment to steering and wheel
/// forces.
#pragma once

#include "awmr/model/scalar_math.h"
#include "awmr/model/yaw_mode.h"

namespace awmr {

/// How combined mode distributes the yaw moment when the steering or the wheel forces are at a
/// limit.
enum class CombinedSplit {
  kFixedHalf,     ///< as in the paper: each makes half of the moment, also at a limit
  kRedistribute,  ///< each makes the moment that the other cannot make at its limit
};

/// Share of the yaw moment that the steering makes: 0 differential, 1/2 combined, 1 steering.
template <class T>
constexpr T steering_share(YawMode mode) {
  return mode == YawMode::kCombined ? T(0.5) : T(mode == YawMode::kSteering ? 1.0 : 0.0);
}

/// Distribution of the yaw moment to steering and wheel forces.
template <class T>
struct YawSplit {
  T steering_share;       ///< s: fraction of the moment that steering makes
  Mask<T> redistributes;  ///< true: combined mode with CombinedSplit::kRedistribute
};

template <class T>
YawSplit<T> yaw_split(YawMode mode, CombinedSplit split) {
  const bool combined = mode == YawMode::kCombined;
  return {steering_share<T>(mode), Mask<T>(combined && split == CombinedSplit::kRedistribute)};
}

}  // namespace awmr
