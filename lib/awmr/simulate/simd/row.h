/// `Row`: one number of each of the sixteen runs that are simulated together. Plain data, because
/// kernels share no functions with the rest of the program (README.md, rules for kernel code).
#pragma once

namespace awmr {
namespace lanes {

/// Number of runs in a block: the runs that are simulated together, the same for every instruction
/// set. A kernel processes a block in groups of Lanes::kCount runs: eight with AVX-512, four with
/// AVX2, two with NEON.
constexpr int kLanes = 16;

struct alignas(64) Row {
  double lane[kLanes];
  Row() = default;
  explicit Row(double all) {
    for (double& one : lane) one = all;
  }
};

}  // namespace lanes
}  // namespace awmr
