/// One number of each of sixteen runs that are simulated together. Plain data, because the kernels
/// are compiled for other instruction sets and share no code with the rest of the program.
#pragma once

namespace awmr {
namespace lanes {

/// Number of runs in a block, the same for every instruction set: one, two or four steps of a
/// kernel.
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
