/// Two methods that compute wheel forces and steering angle from thrust and yaw moment (the
/// allocation): exact, and for small angles. Freestanding C++14.
#pragma once

namespace awmr {

/// Equations by which control/allocation.h computes forces and steering angle.
enum class AllocationForm {
  kExact,  ///< the exact inverse of generalised_forces() (dynamics.h)
  kPaper,  ///< the paper's inverse for small angles: sin d_r = d_r and cos d_r = 1
};

}  // namespace awmr
