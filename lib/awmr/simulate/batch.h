/// Simulates any number of runs of a scenario, up to sixteen at once, in the closed loop of
/// simulate() (closed_loop.h). Each run has one lane (element) of the processor's vector registers.
///
/// The results of a run do not depend on the other runs or on its lane. They equal those of
/// simulate() except for rounding, because powers and angles are computed by polynomials of this
/// project instead of the C library.
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
/// differ only in plant, gains or mode can share these numbers instead of drawing them again, which
/// saves a tenth of their computing time.
struct DrawnNoise {
  std::vector<double> heading, yaw_rate, speed;  ///< empty: the sensor has no noise
};

/// Draws the noise numbers of a run with this seed and `sample` (number of the draw): the same
/// numbers that the run would draw itself. Memory: up to 24 bytes per sample time of the run.
DrawnNoise draw_sensor_noise(const Scenario& scenario, double sample_time_s, std::uint64_t seed,
                             std::uint64_t sample);

/// One run of a batch: vehicle, controller, yaw mode and random numbers.
struct BatchRun {
  Plant<double> plant;
  Controller<double> controller;
  YawMode mode;
  std::uint64_t seed = 0;    ///< as in SimulateOptions
  std::uint64_t sample = 0;  ///< as in SimulateOptions
  /// Null, or the result of draw_sensor_noise() for the run's scenario, seed and sample. The result
  /// of the run is the same in both cases; with the drawn numbers, it is computed faster.
  const DrawnNoise* noise = nullptr;
};

/// Instruction set with which batches are simulated, and how it rounds.
struct BatchArithmetic {
  /// "avx512", "avx2", "neon"; "scalar": by simulate(), one run at a time.
  std::string_view instructions;
  /// "fused" (a b + c is rounded once) for every vector instruction set, "scalar" for simulate().
  /// Results of two machines can be identical only if their `rounding` is the same.
  std::string_view rounding;
};

/// Largest number of runs that are simulated at once (a block).
inline constexpr std::size_t kBatchRuns = 16;

/// The widest instruction set of this processor, or, for tests, the one in the environment variable
/// AWMR_INSTRUCTIONS. Errors (input): the requested instruction set is not available.
Result<BatchArithmetic> batch_arithmetic();

/// Simulates the runs and returns the metrics of each, in order. A run that fails has an error
/// (input) of failure_of(). Precondition: the controllers of all runs have the same driven wheels,
/// combined split and form of the allocation.
std::vector<Result<Metrics>> simulate_batch(std::span<const BatchRun> runs,
                                            const Scenario& scenario, double sample_time_s,
                                            const BatchArithmetic& arithmetic);

/// A run with its metrics.
struct DrivenRun {
  Run run;
  Metrics metrics;
};
/// Simulates the runs like simulate_batch(), and also returns the rows of each run. A run that
/// fails in the batch is simulated again with simulate(). If that fails too, its Run::end is
/// kFailed.
std::vector<DrivenRun> drive_batch(std::span<const BatchRun> runs, const Scenario& scenario,
                                   double sample_time_s, const BatchArithmetic& arithmetic);

}  // namespace awmr
