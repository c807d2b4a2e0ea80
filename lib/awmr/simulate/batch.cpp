#include "awmr/simulate/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "awmr/simulate/closed_loop.h"
#include "awmr/simulate/lanes/kernels.h"

namespace awmr {
namespace {

using lanes::Kernel;

static_assert(kBatchRuns == kRunsOf<lanes::Row>);

DrivenRun one_by_one(const BatchRun& run, const Scenario& scenario, double sample_time_s) {
  DrivenRun driven{.run = simulate(run.plant, run.controller, scenario, run.mode,
                                   {.sample_time_s = sample_time_s,
                                    .substeps = {},
                                    .seed = run.seed,
                                    .sample = run.sample,
                                    .noise = run.noise}),
                   .metrics = {}};
  driven.metrics = metrics_of(driven.run, scenario, run.controller);
  return driven;
}

const Kernel* kernel_of(const BatchArithmetic& arithmetic) {
  for (const Kernel* one : lanes::supported_kernels()) {
    if (one->name == arithmetic.instructions) return one;
  }
  return nullptr;
}

/// Simulates the runs in blocks of up to kBatchRuns. Calls take(i, metrics, run) for each run i, in
/// order. `metrics` is empty if the run failed, or if there is no kernel for this processor; `run`
/// has rows only if `keeps_rows`.
template <class Take>
void drive_by_blocks(std::span<const BatchRun> runs, const Scenario& scenario, double sample_time_s,
                     const BatchArithmetic& arithmetic, bool keeps_rows, const Take& take) {
  const Kernel* const kernel = kernel_of(arithmetic);
  for (std::size_t first = 0; first < runs.size(); first += kBatchRuns) {
    const auto block = runs.subspan(first, std::min(kBatchRuns, runs.size() - first));
    if (!kernel) {
      for (std::size_t i = 0; i < block.size(); ++i) take(first + i, std::nullopt, Run{});
      continue;
    }
    ClosedLoop<lanes::Row> loop(block, scenario, *kernel,
                                {.sample_time_s = sample_time_s,
                                 .samples = samples_in(scenario.duration_s, sample_time_s),
                                 .keeps_rows = keeps_rows,
                                 .has_metrics = true});
    loop.drive();
    for (std::size_t i = 0; i < block.size(); ++i) {
      take(first + i, loop.metrics(i), loop.take_run(i));
    }
  }
}

}  // namespace

Result<BatchArithmetic> batch_arithmetic() {
  const char* requested = std::getenv("AWMR_INSTRUCTIONS");
  const auto kernels = lanes::supported_kernels();
  const std::string_view name = requested         ? requested
                                : kernels.empty() ? "scalar"
                                                  : kernels.front()->name;
  if (name == "scalar") return BatchArithmetic{"scalar", "scalar"};
  std::string known = "scalar";
  for (const Kernel* kernel : kernels) {
    if (name == kernel->name) return BatchArithmetic{kernel->name, "fused"};
    known += fmt::format(", {}", kernel->name);
  }
  return input_error(ErrorCode::kUnknownName, "AWMR_INSTRUCTIONS",
                     fmt::format("unsupported instruction set '{}'; available: {}", name, known));
}

std::vector<Result<Metrics>> simulate_batch(std::span<const BatchRun> runs,
                                            const Scenario& scenario, double sample_time_s,
                                            const BatchArithmetic& arithmetic) {
  std::vector<Result<Metrics>> results;
  drive_by_blocks(
      runs, scenario, sample_time_s, arithmetic, false,
      [&](std::size_t i, const std::optional<Metrics>& metrics, const Run&) {
        if (metrics) {
          results.emplace_back(*metrics);
          return;
        }
        // The run failed in the batch. simulate() repeats it and either succeeds or gives the
        // error.
        const DrivenRun one = one_by_one(runs[i], scenario, sample_time_s);
        const Status failure = failure_of(one.run, scenario);
        results.push_back(failure ? Result<Metrics>(one.metrics) : tl::unexpected(failure.error()));
      });
  return results;
}

std::vector<DrivenRun> drive_batch(std::span<const BatchRun> runs, const Scenario& scenario,
                                   double sample_time_s, const BatchArithmetic& arithmetic) {
  std::vector<DrivenRun> driven;
  drive_by_blocks(runs, scenario, sample_time_s, arithmetic, true,
                  [&](std::size_t i, const std::optional<Metrics>& metrics, Run run) {
                    driven.push_back(metrics ? DrivenRun{std::move(run), *metrics}
                                             : one_by_one(runs[i], scenario, sample_time_s));
                  });
  return driven;
}

}  // namespace awmr
