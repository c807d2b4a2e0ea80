/// The three modes of making a yaw moment. Freestanding C++14.
#pragma once

namespace awmr {

enum class YawMode {
  kDifferential,  ///< by the difference of right and left forces, wheels straight
  kSteering,      ///< by the steered front wheels, right and left forces equal
  kCombined,      ///< half of the moment by each method
};

/// Action of the combined mode when one of its two paths saturates.
enum class CombinedSplit {
  kFixedHalf,     ///< as in the paper: half of tau_turn each way, regardless of limits
  kRedistribute,  ///< the part that the saturated path cannot make goes to the other path
};

}  // namespace awmr
