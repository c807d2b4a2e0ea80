/// The two forms of the allocation. Freestanding C++14.
#pragma once

namespace awmr {

/// Forms of computing forces and steering angle from the generalised forces: control/allocation.h.
enum class AllocationForm {
  kExact,  ///< the exact inverse of generalised_forces()
  kPaper,  ///< its inverse for small angles, sin d_r = d_r and cos d_r = 1: the paper's
};

}  // namespace awmr
