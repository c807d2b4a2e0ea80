#include "awmr/simulate/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "awmr/simulate/closed_loop.h"
#include "awmr/simulate/simd/kernels.h"

namespace awmr {
namespace {

using lanes::Kernel;

static_assert(kBatchRuns == kRunsOf<lanes::Row>);

DrivenRun one_by_one(const BatchRun& run, const Scenario& scenario, double sample_time_s,
                     bool keeps_rows) {
  DrivenRun driven{.run = simulate(run.plant, run.controller, scenario, run.mode,
                                   {.sample_time_s = sample_time_s,
                                    .seed = run.seed,
                                    .sample = run.sample,
                                    .noise = run.noise}),
                   .metrics = {}};
  driven.metrics = metrics_of(driven.run, scenario, run.controller);
  std::vector<RunRow>& rows = driven.run.rows;
  if (!keeps_rows) rows = std::vector<RunRow>{rows.back()};
  return driven;
}

const Kernel* kernel_of(const BatchArithmetic& arithmetic) {
  for (const Kernel* one : lanes::supported_kernels()) {
    if (one->name == arithmetic.instructions) return one;
  }
  return nullptr;
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

std::vector<DrivenRun> simulate_batch(std::span<const BatchRun> runs, const Scenario& scenario,
                                      double sample_time_s, const BatchArithmetic& arithmetic,
                                      bool keeps_rows) {
  const Kernel* const kernel = kernel_of(arithmetic);
  std::vector<DrivenRun> driven;
  for (std::size_t first = 0; first < runs.size(); first += kBatchRuns) {
    const auto block = runs.subspan(first, std::min(kBatchRuns, runs.size() - first));
    std::optional<ClosedLoop<lanes::Row>> loop;
    if (kernel) {
      loop.emplace(block, scenario, *kernel,
                   LoopOptions{.sample_time_s = sample_time_s,
                               .samples = samples_in(scenario.duration_s, sample_time_s),
                               .keeps_rows = keeps_rows,
                               .has_metrics = true});
      loop->drive();
    }
    for (std::size_t i = 0; i < block.size(); ++i) {
      const auto metrics = loop ? loop->metrics(i) : std::nullopt;
      driven.push_back(metrics ? DrivenRun{loop->take_run(i), *metrics}
                               : one_by_one(block[i], scenario, sample_time_s, keeps_rows));
    }
  }
  return driven;
}

}  // namespace awmr
