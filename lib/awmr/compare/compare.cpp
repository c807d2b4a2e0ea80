#include "awmr/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "awmr/compare/draw.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

constexpr std::size_t kModeCount = std::size(kYawModes);

std::vector<Fault> option_faults(const std::vector<NamedGains>& gains,
                                 const std::vector<Scenario>& scenarios,
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
  std::set<std::string> sets;
  for (const NamedGains& set : gains) {
    if (!sets.insert(set.name).second) {
      faults.push_back({"--gains", fmt::format("two sets of gains are named '{}'", set.name)});
    }
  }
  if (gains.empty()) faults.push_back({"--gains", "none given; give at least one"});
  return faults;
}

/// The vehicles that are run: by sample, and by scenario where it has a corner.
class Fleet {
 public:
  static Result<Fleet> make(const Model& model,
                            const std::vector<Scenario>& scenarios, const CompareOptions& options) {
    const Result<Plant<double>> nominal = model.plant();
    if (!nominal) return tl::unexpected(nominal.error());
    std::vector<Model> drawn{model};
    if (options.samples > 0) {
      const Result<PlantSampler> sampler = PlantSampler::make(model);
      if (!sampler) return tl::unexpected(sampler.error());
      for (int sample = 1; sample <= options.samples; ++sample) {
        Result<Model> one = sampler->draw_model(options.seed, sample);
        if (!one) return tl::unexpected(one.error());
        drawn.push_back(std::move(*one));
      }
    }
    Fleet fleet;
    for (const Scenario& scenario : scenarios) {
      fleet.first_.push_back(fleet.plants_.size());
      // Without a corner the vehicles are those of the first scenario without one.
      if (scenario.corner.empty()) {
        if (fleet.plain_) {
          fleet.first_.back() = *fleet.plain_;
          continue;
        }
        fleet.plain_ = fleet.plants_.size();
      }
      for (const Model& one : drawn) {
        const Result<Plant<double>> plant = plant_for(scenario, one);
        if (!plant) return tl::unexpected(plant.error());
        fleet.plants_.push_back(*plant);
      }
    }
    fleet.nominal_ = *nominal;
    return fleet;
  }
  const Plant<double>& nominal() const { return nominal_; }
  const Plant<double>& at(std::size_t scenario, std::size_t sample) const {
    return plants_[first_[scenario] + sample];
  }

 private:
  Plant<double> nominal_{};
  std::vector<Plant<double>> plants_;
  std::vector<std::size_t> first_;    ///< by scenario, into plants_
  std::optional<std::size_t> plain_;  ///< into plants_
};

/// Where a row stands: by scenario, gains, mode, sample.
struct Layout {
  std::size_t scenarios, gains, samples;
  std::size_t contenders() const { return gains * kModeCount; }
  std::size_t count() const { return scenarios * contenders() * samples; }
  std::size_t index(std::size_t scenario, std::size_t contender, std::size_t sample) const {
    return (scenario * contenders() + contender) * samples + sample;
  }
};

/// The rows, each once it is finished.
using Slots = std::vector<std::optional<ComparisonRow>>;

template <class Items, class Same>
std::optional<std::size_t> position_of(const Items& items, const Same& same) {
  const auto found = std::find_if(std::begin(items), std::end(items), same);
  if (found == std::end(items)) return std::nullopt;
  return static_cast<std::size_t>(found - std::begin(items));
}

Status take_finished(const std::vector<Scenario>& scenarios, const std::vector<NamedGains>& gains,
                     const CompareOptions& options, const Layout& layout, Slots& slots) {
  for (const ComparisonRow& row : options.finished) {
    const auto scenario =
        position_of(scenarios, [&](const Scenario& other) { return other.name == row.scenario; });
    const auto set =
        position_of(gains, [&](const NamedGains& other) { return other.name == row.gains; });
    const auto mode = position_of(kYawModes, [&](YawMode other) { return other == row.mode; });
    if (!scenario || !set || !mode || row.sample < 0) {
      return input_error("--resume",
                         fmt::format("the finished run of '{}' in sample {} is none of this "
                                     "comparison's; compare into another directory",
                                     row.scenario, row.sample));
    }
    const auto sample = static_cast<std::size_t>(row.sample);
    if (sample >= layout.samples) continue;  // fewer samples are asked for now
    slots[layout.index(*scenario, *set * kModeCount + *mode, sample)] = row;
  }
  return {};
}

/// Runs task(0) ... task(count - 1) once each, in any order, until `stop`; `after` is called on
/// this thread. What a task throws comes out here.
template <class Task, class After>
void run_in_parallel(std::size_t count, int threads, const std::atomic<bool>* stop,
                     const Task& task, const After& after) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr thrown;
  std::mutex thrown_mutex;
  const auto work = [&](const auto& then) {
    try {
      for (std::size_t i = next++; i < count; i = next++) {
        if (stop != nullptr && stop->load()) return;
        task(i);
        then();
      }
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
    for (std::size_t i = 1; i < std::min(wanted, count); ++i) {
      helpers.emplace_back([&] { work([] {}); });
    }
    work(after);
  }
  if (thrown) std::rethrow_exception(thrown);
}

Comparison gathered(const Layout& layout, Slots slots) {
  Comparison comparison;
  std::size_t whole = layout.samples;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i]) {
      comparison.rows.push_back(std::move(*slots[i]));
    } else {
      whole = std::min(whole, i % layout.samples);
      comparison.stopped = true;
    }
  }
  comparison.whole_samples = static_cast<int>(whole);
  return comparison;
}

}  // namespace

Result<Comparison> compare(const Model& model,
                           const std::vector<NamedGains>& gains,
                           const std::vector<Scenario>& scenarios, const CompareOptions& options) {
  std::vector<Fault> faults = option_faults(gains, scenarios, options);
  if (!faults.empty()) return input_errors(std::move(faults));
  const auto fleet = Fleet::make(model, scenarios, options);
  if (!fleet) return tl::unexpected(fleet.error());

  const Layout layout{scenarios.size(), gains.size(),
                      static_cast<std::size_t>(options.samples) + 1};
  Slots slots(layout.count());
  if (const Status taken = take_finished(scenarios, gains, options, layout, slots); !taken) {
    return tl::unexpected(taken.error());
  }
  const auto run_one = [&](std::size_t scenario, std::size_t contender, std::size_t sample) {
    const NamedGains& set = gains[contender / kModeCount];
    const YawMode mode = kYawModes[contender % kModeCount];
    // The controller knows the model's own values, not the drawn ones.
    const Controller<double> controller =
        make_controller(fleet->nominal(), model.vehicle, set.gains);
    // Sample 0 is the run of `awmr simulate`: the scenario's seed alone.
    const Run run = simulate(fleet->at(scenario, sample), controller, scenarios[scenario], mode,
                             {.sample_time_s = model.vehicle.sample_time_s,
                              .substeps = {},
                              .seed = sample == 0 ? 0 : options.seed,
                              .sample = sample});
    return ComparisonRow{.scenario = scenarios[scenario].name,
                         .mode = mode,
                         .sample = static_cast<int>(sample),
                         .metrics = metrics_of(run, scenarios[scenario], controller),
                         .gains = set.name};
  };
  std::atomic<std::size_t> done = 0;
  const std::size_t per_sample = layout.scenarios * layout.contenders();
  // Each task owns one slot, so the order in which threads take them leaves no trace.
  run_in_parallel(
      layout.count(), options.threads, options.stop,
      [&](std::size_t i) {
        const std::size_t sample = i / per_sample;
        const std::size_t scenario = i % per_sample / layout.contenders();
        const std::size_t contender = i % layout.contenders();
        auto& slot = slots[layout.index(scenario, contender, sample)];
        if (!slot) slot = run_one(scenario, contender, sample);
        ++done;
      },
      [&] {
        if (options.progress) options.progress(done, layout.count());
      });
  return gathered(layout, std::move(slots));
}

Result<Comparison> compare(const Model& model,
                           const Gains<double>& gains, const std::vector<Scenario>& scenarios,
                           const CompareOptions& options) {
  return compare(model, std::vector<NamedGains>{{"", gains}}, scenarios, options);
}

}  // namespace awmr
