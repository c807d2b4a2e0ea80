#include "awmr/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "awmr/compare/draw.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

constexpr std::size_t kModeCount = std::size(kYawModes);

std::vector<Fault> option_faults(const std::vector<Scenario>& scenarios,
                                 const CompareOptions& options) {
  std::vector<Fault> faults;
  if (options.samples < 0) {
    faults.push_back({"--samples", fmt::format("has to be 0 or more, found {}", options.samples)});
  }
  if (options.threads < 0) {
    faults.push_back({"--threads", fmt::format("has to be 0 or more, found {}", options.threads)});
  }
  if (scenarios.empty()) faults.push_back({"--scenario", "none given; give at least one"});
  std::set<std::string> names;
  for (const Scenario& scenario : scenarios) {
    if (!names.insert(scenario.name).second) {
      faults.push_back({"--scenario", fmt::format("two scenarios are named '{}'; the rows could "
                                                  "not be told apart: rename one",
                                                  scenario.name)});
    }
  }
  return faults;
}

/// The model's own plant, then one per sample.
Result<std::vector<Plant<double>>> plants_of(const Model& model, const std::string& model_file,
                                             const CompareOptions& options) {
  const Result<Plant<double>> nominal = model.plant(model_file);
  if (!nominal) return tl::unexpected(nominal.error());
  std::vector<Plant<double>> plants{*nominal};
  if (options.samples == 0) return plants;
  const Result<PlantSampler> sampler = PlantSampler::make(model, model_file);
  if (!sampler) return tl::unexpected(sampler.error());
  for (int sample = 1; sample <= options.samples; ++sample) {
    const Result<Plant<double>> plant = sampler->draw(options.seed, sample);
    if (!plant) return tl::unexpected(plant.error());
    plants.push_back(*plant);
  }
  return plants;
}

/// Runs task(0) ... task(count - 1) once each, in any order. What a task throws comes out here.
template <class Task>
void run_in_parallel(std::size_t count, int threads, const Task& task) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr thrown;
  std::mutex thrown_mutex;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) task(i);
    } catch (...) {
      const std::lock_guard lock(thrown_mutex);
      thrown = std::current_exception();
      next = count;
    }
  };
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted = threads == 0 ? cores : static_cast<std::size_t>(threads);
  {
    std::vector<std::jthread> helpers;
    // This thread works too.
    for (std::size_t i = 1; i < std::min(wanted, count); ++i) helpers.emplace_back(work);
    work();
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace

Result<Comparison> compare(const Model& model, const std::string& model_file,
                           const Gains<double>& gains, const std::vector<Scenario>& scenarios,
                           const CompareOptions& options) {
  std::vector<Fault> faults = option_faults(scenarios, options);
  if (!faults.empty()) return input_errors(std::move(faults));
  const auto plants = plants_of(model, model_file, options);
  if (!plants) return tl::unexpected(plants.error());

  // The controller knows the model's own values, not the drawn ones.
  const Controller<double> controller = make_controller(plants->front(), model.vehicle, gains);
  const std::size_t samples = plants->size();
  Comparison comparison;
  comparison.rows.resize(scenarios.size() * kModeCount * samples);
  // Each task owns one row, so the order in which threads take them leaves no trace.
  run_in_parallel(comparison.rows.size(), options.threads, [&](std::size_t i) {
    const Scenario& scenario = scenarios[i / (kModeCount * samples)];
    const std::size_t sample = i % samples;
    const YawMode mode = kYawModes[(i / samples) % kModeCount];
    const Run run = simulate((*plants)[sample], controller, scenario, mode,
                             {.sample_time_s = model.vehicle.sample_time_s, .substeps = {}});
    comparison.rows[i] = {.scenario = scenario.name,
                          .mode = mode,
                          .sample = static_cast<int>(sample),
                          .metrics = metrics_of(run, scenario, controller)};
  });
  return comparison;
}

}  // namespace awmr
