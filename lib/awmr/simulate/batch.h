/// Many runs at once, a lane of the processor's vector registers each. Guidance, sensors and events
/// go on lane by lane; the laws, the allocation, the motion and the metrics are those of simulate(),
/// the same templates on batches of numbers.
///
/// A run's numbers do not depend on the runs beside it, nor on its place among them. They are those of
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

/// One of the runs: its vehicle, the controller, how it turns, and where its random numbers come from.
struct BatchRun {
  Plant<double> plant;
  Controller<double> controller;
  YawMode mode;
  std::uint64_t seed = 0;    ///< as in SimulateOptions
  std::uint64_t sample = 0;  ///< as in SimulateOptions
};

/// The numbers of which the motion's steps are made. Float32 is faster: twice as many fit into a
/// register. The state, the laws and the metrics are doubles either way.
enum class StepFormat { kDouble, kFloat32 };

/// By which instructions batches are computed.
struct BatchArithmetic {
  /// "avx512", "avx2", "sse2", "neon"; "scalar": by simulate(), one by one.
  std::string_view instructions;
  /// What results of different machines have to have in common to be the same bytes: "fused" where
  /// a b + c is rounded once, whatever the instructions; "unfused"; or "scalar". With steps of
  /// float32 "fused float32" or "unfused float32".
  std::string_view rounding;
};

/// Whether runs of this rounding take steps of float32.
constexpr bool is_float32(std::string_view rounding) { return rounding.ends_with(" float32"); }

/// How many runs fill the registers: a multiple of it leaves no lane idle.
inline constexpr std::size_t kBatchRuns = 16;

/// The widest instructions that this processor has, or those named by the environment variable
/// AWMR_INSTRUCTIONS, for tests.
/// Errors (input): it names none that the processor has; float32 is asked for where no vector
/// instructions are.
Result<BatchArithmetic> batch_arithmetic(StepFormat format = StepFormat::kDouble);

/// Errors (input): steps of float32 are not made for the scenario or the vehicle, whose runs would
/// all be simulate()'s: one on four tyres, or one of front-wheel drive.
Status check_float32(const Scenario& scenario, const Plant<double>& plant);

/// The metrics of each run, in order. Errors (input) of a run: as failure_of(). All controllers
/// have the same allocation, split and form. `by_simulate`, where it is given, is told of each run
/// whether simulate() had to drive it, in double whatever the arithmetic: no kernel is made for it,
/// or its lane could not finish it.
std::vector<Result<Metrics>> simulate_batch(std::span<const BatchRun> runs,
                                            const Scenario& scenario, double sample_time_s,
                                            const BatchArithmetic& arithmetic,
                                            std::vector<bool>* by_simulate = nullptr);

/// A run with what it is judged by.
struct DrivenRun {
  Run run;
  Metrics metrics;
};
/// The same runs with their rows, for who asks more of a run than its metrics. One that fails is as
/// simulate() leaves it.
std::vector<DrivenRun> drive_batch(std::span<const BatchRun> runs, const Scenario& scenario,
                                   double sample_time_s, const BatchArithmetic& arithmetic);

}  // namespace awmr
