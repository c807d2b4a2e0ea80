/// The three ways to make a yaw moment. Freestanding C++14.
#pragma once

namespace awmr {

enum class YawMode { kDifferential, kSteering, kCombined };

/// What the combined mode does when one of its two paths saturates.
enum class CombinedSplit {
  kFixedHalf,     ///< half of tau_turn each way, whatever is lost             [paper (42), corrected]
  kRedistribute,  ///< what the saturated path cannot deliver goes to the other path
};

}  // namespace awmr
