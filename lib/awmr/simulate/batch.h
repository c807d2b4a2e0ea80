/// Simulates any number of runs of a scenario, up to sixteen at once, in the closed loop of
/// closed_loop.h. Each run has one lane (element) of the processor's vector registers. Its results
/// do not depend on the other runs or on its lane. They equal those of simulate() except for
/// rounding, because polynomials of this project replace the C library in powers and angles.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Standard normal numbers for the sensor noise of a run, one per sample and sensor. Runs that
/// differ only in plant, gains or mode can share them: drawing them only once saves a tenth of the
/// computing time of each run.
struct DrawnNoise {
  std::vector<double> heading, yaw_rate, speed;  ///< empty: the sensor has no noise
};

/// Draws the sensor noise that a run with this seed and draw number `sample` would draw itself.
/// Memory: up to 24 bytes per sample time of the run.
DrawnNoise draw_sensor_noise(const Scenario& scenario, double sample_time_s, std::uint64_t seed,
                             std::uint64_t sample);

/// One run of a batch: vehicle, controller, yaw mode and random numbers.
struct BatchRun {
  Plant<double> plant;
  Controller<double> controller;
  YawMode mode;
  std::uint64_t seed = 0;    ///< as in SimulateOptions
  std::uint64_t sample = 0;  ///< as in SimulateOptions
  /// The result of draw_sensor_noise() for the run's scenario, seed and sample, or null. If it is
  /// null, the run draws the same numbers itself, which takes longer.
  const DrawnNoise* noise = nullptr;
};

/// Instruction set with which batches are simulated, and how it rounds.
struct BatchArithmetic {
  /// "avx512", "avx2" or "neon"; "scalar": simulate() computes one run at a time.
  std::string_view instructions;
  /// Rounding of a b + c: "fused" (once; vector instruction sets) or "scalar" (twice; simulate()).
  /// Two machines with different `rounding` give different results.
  std::string_view rounding;
};

/// Number of runs in a block: the runs that are simulated at once.
inline constexpr std::size_t kBatchRuns = 16;

/// Returns the widest instruction set of this processor. Tests can select another one by the
/// environment variable AWMR_INSTRUCTIONS. Errors (input): the selected instruction set is not
/// available.
Result<BatchArithmetic> batch_arithmetic();

/// A run of a batch with its metrics.
struct DrivenRun {
  Run run;
  Metrics metrics;
};

/// Simulates the runs; returns them in order, with all rows if `keeps_rows` is true. simulate()
/// repeats a run that fails in the batch. If it fails again, Run::end is kFailed, the metrics are
/// those up to the failure, and the last row is there for failure_of(). Precondition: the
/// controllers of all runs have the same driven wheels, combined split and form of the allocation.
std::vector<DrivenRun> simulate_batch(std::span<const BatchRun> runs, const Scenario& scenario,
                                      double sample_time_s, const BatchArithmetic& arithmetic,
                                      bool keeps_rows = false);

}  // namespace awmr
