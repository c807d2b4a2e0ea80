/// The three ways to make a yaw moment. Freestanding C++14.
#pragma once

namespace awmr {

enum class YawMode {
  kDifferential,  ///< by the difference of right and left forces, wheels straight
  kSteering,      ///< by the steered front wheels, right and left forces equal
  kCombined,      ///< half of the moment by each
};

/// What the combined mode does when one of its two paths saturates.
enum class CombinedSplit {
  kFixedHalf,     ///< as in the paper: half of tau_turn each way, whatever the limits take away
  kRedistribute,  ///< what the saturated path cannot deliver goes to the other path
};

}  // namespace awmr
