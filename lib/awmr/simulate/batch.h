/// Many runs at once, a lane of the processor's vector registers each, through the closed loop of
/// simulate() (closed_loop.h).
///
/// A run's numbers do not depend on the other runs, nor on its place among them. They are those of
/// simulate() but for rounding: powers and angles are computed by other polynomials.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Standard normals by sample that the sensors of a run take their noise from. Runs that differ in plant, gains
/// or mode alone share them: drawing them takes as long as a tenth of a run.
struct DrawnNoise {
  std::vector<double> heading, yaw_rate, speed;  ///< empty: the sensor has no noise
};

/// The numbers that a run with this seed and sample draws. Some 24 bytes a sample.
DrawnNoise draw_sensor_noise(const Scenario& scenario, double sample_time_s, std::uint64_t seed,
                             std::uint64_t sample);

/// One of the runs: its vehicle, the controller, how it turns, and where its random numbers come from.
struct BatchRun {
  Plant<double> plant;
  Controller<double> controller;
  YawMode mode;
  std::uint64_t seed = 0;    ///< as in SimulateOptions
  std::uint64_t sample = 0;  ///< as in SimulateOptions
  /// Null, or draw_sensor_noise() of the run's scenario, seed and sample: the same numbers, faster.
  const DrawnNoise* noise = nullptr;
};

/// By which instructions batches are computed.
struct BatchArithmetic {
  /// "avx512", "avx2", "neon"; "scalar": by simulate(), one by one.
  std::string_view instructions;
  /// Arithmetic that results of different machines must share to have the same bytes: "fused" (a b
  /// + c is rounded once) for every vector instruction set, "scalar" for simulate().
  std::string_view rounding;
};

/// Number of runs that fill the registers; a multiple of it leaves no lane idle.
inline constexpr std::size_t kBatchRuns = 16;

/// The widest instructions that this processor has, or those named by the environment variable
/// AWMR_INSTRUCTIONS, for tests.
/// Errors (input): it names none that the processor has.
Result<BatchArithmetic> batch_arithmetic();

/// The metrics of each run, in order. Errors (input) of a run: as failure_of(). All controllers have
/// the same driven wheels, split and form of the allocation.
std::vector<Result<Metrics>> simulate_batch(std::span<const BatchRun> runs,
                                            const Scenario& scenario, double sample_time_s,
                                            const BatchArithmetic& arithmetic);

/// A run with its metrics.
struct DrivenRun {
  Run run;
  Metrics metrics;
};
/// The same runs with their rows, for who asks more of a run than its metrics. One that fails is as
/// simulate() leaves it.
std::vector<DrivenRun> drive_batch(std::span<const BatchRun> runs, const Scenario& scenario,
                                   double sample_time_s, const BatchArithmetic& arithmetic);

}  // namespace awmr
