/// One number of each of the sixteen runs that are simulated together. Plain data, because the
/// kernels are compiled for other instruction sets and must not share code with the rest of the
/// program.
#pragma once

namespace awmr {
namespace lanes {

/// Number of runs in a block, the same for every instruction set. A kernel processes a block in one,
/// two or four parts, depending on its lanes per batch.
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
