/// Batches of runs of the closed loop of simulate() (closed_loop.h), one run per lane of the
/// processor's vector registers.
///
/// The results of a run do not depend on the other runs or on its position. They equal those of
/// simulate() up to rounding, because powers and angles are computed by other polynomials.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Standard normals by sample, for the sensor noise of a run. Runs that differ only in plant, gains
/// or mode share them, because drawing them takes a tenth of the time of a run.
struct DrawnNoise {
  std::vector<double> heading, yaw_rate, speed;  ///< empty: the sensor has no noise
};

/// The numbers that a run with this seed and sample draws, about 24 bytes per sample.
DrawnNoise draw_sensor_noise(const Scenario& scenario, double sample_time_s, std::uint64_t seed,
                             std::uint64_t sample);

/// One of the runs: vehicle, controller, yaw mode and random numbers.
struct BatchRun {
  Plant<double> plant;
  Controller<double> controller;
  YawMode mode;
  std::uint64_t seed = 0;    ///< as in SimulateOptions
  std::uint64_t sample = 0;  ///< as in SimulateOptions
  /// Null, or draw_sensor_noise() of the run's scenario, seed and sample: the same numbers, faster.
  const DrawnNoise* noise = nullptr;
};

/// Instruction set for batches.
struct BatchArithmetic {
  /// "avx512", "avx2", "neon"; "scalar": by simulate(), one run at a time.
  std::string_view instructions;
  /// Results of two machines have the same bytes only if this is the same: "fused" (a b + c is
  /// rounded once) for every vector instruction set, "scalar" for simulate().
  std::string_view rounding;
};

/// Number of runs that fill the registers.
inline constexpr std::size_t kBatchRuns = 16;

/// The widest instruction set of this processor, or the one in the environment variable
/// AWMR_INSTRUCTIONS, for tests. Errors (input): the processor does not have that one.
Result<BatchArithmetic> batch_arithmetic();
/// Its rounding; empty on an error.
std::string batch_rounding();

/// The metrics of each run, in order. Errors (input) of a run: as failure_of(). All controllers
/// have the same driven wheels, split and form of the allocation.
std::vector<Result<Metrics>> simulate_batch(std::span<const BatchRun> runs,
                                            const Scenario& scenario, double sample_time_s,
                                            const BatchArithmetic& arithmetic);

/// A run with its metrics.
struct DrivenRun {
  Run run;
  Metrics metrics;
};
/// The same runs with their rows. A run that fails is the result of simulate().
std::vector<DrivenRun> drive_batch(std::span<const BatchRun> runs, const Scenario& scenario,
                                   double sample_time_s, const BatchArithmetic& arithmetic);

}  // namespace awmr
