#include "awmr/compare/compare.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "awmr/compare/break_even.h"
#include "awmr/compare/comparison_inputs.h"
#include "awmr/compare/decision.h"
#include "awmr/core/index.h"
#include "awmr/core/parallel.h"
#include "awmr/model/fitted_law.h"
#include "awmr/simulate/batch.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

struct Layout {
  std::size_t scenarios, gains, modes, samples;

  std::size_t count() const { return scenarios * gains * modes * samples; }
};

/// Results of the runs, in the order of the output. An entry is empty until its run is finished.
using Slots = std::vector<std::optional<ComparisonRow>>;

/// Longest run, in control steps, whose sensor noise is drawn once for all modes. Longer noise
/// would take too much memory: 24 bytes per step and run, i.e. up to 38 MB for a batch at this
/// limit.
constexpr double kMaxSharedNoise = 1e5;

/// Sensor noise of some samples of a scenario, which blocks of runs in different modes and with
/// different gains share, possibly on different threads. The first block that needs the noise draws
/// it; the last block frees it.
class SharedNoise {
 public:
  using Drawn = std::vector<DrawnNoise>;  ///< in the order of the samples

  /// Registers a block that will use the noise. Call this for all blocks before the first block
  /// starts: a block that ends frees the noise if no further user is registered.
  void add_user() { ++users_; }

  /// Returns the noise. The first call obtains it from `draw()`.
  template <class Draw>
  const Drawn& drawn(const Draw& draw) {
    std::call_once(once_, [&] { drawn_ = draw(); });
    return drawn_;
  }

  /// Unregisters a block that no longer needs the noise. The last block frees the noise.
  void remove_user() {
    if (--users_ == 0) drawn_.clear();
  }

 private:
  std::once_flag once_;
  std::atomic<std::size_t> users_ = 0;
  Drawn drawn_;
};

/// A batch of runs: one scenario, set of gains and mode, with the samples to run.
struct Block {
  std::size_t scenario, gains, mode;  ///< indices; `mode` in kYawModes
  std::vector<std::size_t> samples;
  /// Sensor noise, shared by all blocks of the same samples in the scenario.
  std::shared_ptr<SharedNoise> noise;

  /// Index of run `i` in the output, whose rows are sorted by scenario, gains, mode and sample.
  std::size_t row(const Layout& all, std::size_t i) const {
    return ((scenario * all.gains + gains) * all.modes + mode) * all.samples + samples[i];
  }
};

/// Divides the samples of this part into blocks of kBatchRuns. The blocks of the same samples in
/// all scenarios, gains and modes follow each other, so that a stopped comparison has complete
/// samples.
std::vector<Block> blocks_of(const Layout& layout, const Shard& shard) {
  std::vector<std::size_t> samples;
  for (std::size_t sample = 0; sample < layout.samples; ++sample) {
    if (shard.has(static_cast<int>(sample))) samples.push_back(sample);
  }
  std::vector<Block> blocks;
  const std::size_t apart = layout.scenarios * layout.gains * layout.modes;
  for (std::size_t first = 0; first < samples.size(); first += kBatchRuns) {
    const std::size_t count = std::min(kBatchRuns, samples.size() - first);
    const std::vector<std::size_t> of_block(samples.begin() + eigen_index(first),
                                            samples.begin() + eigen_index(first + count));
    std::shared_ptr<SharedNoise> noise;
    for (std::size_t i = 0; i < apart; ++i) {
      if (i % (layout.gains * layout.modes) == 0) noise = std::make_shared<SharedNoise>();
      noise->add_user();
      blocks.push_back({.scenario = i / (layout.gains * layout.modes),
                        .gains = i / layout.modes % layout.gains,
                        .mode = i % layout.modes,
                        .samples = of_block,
                        .noise = noise});
    }
  }
  return blocks;
}

std::vector<BatchRun> runs_of(const SampledPlants& plants, const Controller<double>& controller,
                              const Block& block, YawMode mode, std::uint64_t seed) {
  std::vector<BatchRun> runs;
  for (const std::size_t sample : block.samples) {
    // If the seed is 0, sample 0 equals the run of `awmr simulate`, which uses only the scenario's
    // seed.
    runs.push_back({plants.vehicle(block.scenario, sample), controller, mode,
                    sample == 0 ? 0 : seed, static_cast<std::uint64_t>(sample)});
  }
  return runs;
}

/// Gives the block's runs their sensor noise (SharedNoise). Runs longer than kMaxSharedNoise draw
/// the same noise themselves.
void share_noise(const Scenario& scenario, double sample_time_s, const Block& block,
                 std::vector<BatchRun>& runs) {
  if (scenario.duration_s / sample_time_s > kMaxSharedNoise) return;
  const auto& drawn = block.noise->drawn([&] {
    SharedNoise::Drawn noise;
    for (const BatchRun& run : runs) {
      noise.push_back(draw_sensor_noise(scenario, sample_time_s, run.seed, run.sample));
    }
    return noise;
  });
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].noise = &drawn[i];
}

struct RunSetup {
  const Model& model;
  const std::vector<NamedGains>& gains;
  const std::vector<Scenario>& scenarios;
  const CompareOptions& options;
  const SampledPlants& plants;
  const BatchArithmetic& arithmetic;
  Layout layout;
};

/// Runs a block. Stores each result at its row's index in `slots`, or the error in `failures`.
void run_block(const RunSetup& setup, const Block& block, Slots& slots,
               std::vector<Status>& failures) {
  const Vehicle& vehicle = setup.model.vehicle;
  const Scenario& scenario = setup.scenarios[block.scenario];
  const NamedGains& set = setup.gains[block.gains];
  // The controller's model is the nominal plant, also if the simulated plant is drawn.
  const YawMode mode = kYawModes[block.mode];
  const auto controller = make_controller(setup.plants.nominal, vehicle, set.gains.in(mode));
  std::vector<BatchRun> runs = runs_of(setup.plants, controller, block, mode, setup.options.seed);
  share_noise(scenario, vehicle.sample_time_s, block, runs);
  auto driven = simulate_batch(runs, scenario, vehicle.sample_time_s, setup.arithmetic);
  block.noise->remove_user();
  for (std::size_t i = 0; i < driven.size(); ++i) {
    const std::size_t index = block.row(setup.layout, i);
    failures[index] = failure_of(driven[i].run, scenario);
    if (!failures[index]) continue;
    Metrics& metrics = driven[i].metrics;
    metrics.electric_work_j = electric_work_j(metrics, vehicle, runs[i].plant.mass_norm);
    slots[index] = ComparisonRow{.scenario = scenario.name,
                                 .mode = mode,
                                 .sample = static_cast<int>(block.samples[i]),
                                 .metrics = metrics,
                                 .gains = set.name};
  }
}

/// Runs the blocks of this part of the comparison. If the user stops the comparison, the running
/// blocks finish, and no further block starts.
Result<Slots> run_blocks(const RunSetup& setup) {
  const CompareOptions& options = setup.options;
  const std::size_t count = setup.layout.count();
  const std::vector<Block> blocks = blocks_of(setup.layout, options.shard);
  Slots slots(count);
  std::vector<Status> failures(count);
  std::atomic<std::size_t> done = 0;
  LoopControl control;
  if (options.stop != nullptr) control.stop = [&] { return options.stop->load(); };
  if (options.progress) control.progress = [&] { options.progress(done, count); };
  // Each run has its own entry, so the results do not depend on the order of the threads.
  parallel_for(
      blocks.size(), options.threads,
      [&](std::size_t b) {
        run_block(setup, blocks[b], slots, failures);
        done += blocks[b].samples.size();
      },
      control);
  for (const Status& failure : failures) AWMR_RETURN_IF_ERROR(failure);
  return slots;
}

Comparison gathered(const Layout& layout, const Shard& shard, Slots slots) {
  Comparison comparison;
  std::size_t whole = layout.samples;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i]) {
      comparison.rows.push_back(std::move(*slots[i]));
    } else {
      const std::size_t sample = i % layout.samples;
      whole = std::min(whole, sample);
      if (shard.has(static_cast<int>(sample))) comparison.stopped = true;
    }
  }
  comparison.whole_samples = static_cast<int>(whole);
  return comparison;
}

}  // namespace

Result<Comparison> compare(const Model& model, const std::vector<NamedGains>& gains,
                           const std::vector<Scenario>& as_given, const CompareOptions& options) {
  const std::vector<Scenario> scenarios = equipped(model.vehicle, as_given);
  AWMR_RETURN_IF_ERROR(check_comparison(model, gains, scenarios, options));
  AWMR_ASSIGN_OR_RETURN(const SampledPlants plants, sample_plants(model, scenarios, options));
  AWMR_ASSIGN_OR_RETURN(const BatchArithmetic arithmetic, batch_arithmetic());

  const Layout layout{scenarios.size(), gains.size(), yaw_modes(model.vehicle).size(),
                      at(options.samples) + 1};
  AWMR_ASSIGN_OR_RETURN(Slots slots, run_blocks({.model = model,
                                                 .gains = gains,
                                                 .scenarios = scenarios,
                                                 .options = options,
                                                 .plants = plants,
                                                 .arithmetic = arithmetic,
                                                 .layout = layout}));
  Comparison comparison = gathered(layout, options.shard, std::move(slots));
  comparison.arithmetic = arithmetic.rounding;
  comparison.measured_yaw_rate_degps = measured_yaw_rate_degps(model);
  for (const Scenario& scenario : scenarios) {
    comparison.turn_commands.emplace(scenario.name, turn_commands(scenario));
  }
  if (options.break_even && !comparison.stopped) {
    AWMR_ASSIGN_OR_RETURN(comparison.break_even, break_even_of(model, gains.front().gains,
                                                               scenarios, comparison, options));
  }
  if (options.other_settings && options.shard.index == 1 && !comparison.stopped) {
    comparison.changes = changes_of_runs(model, gains, scenarios, options);
    comparison.stopped = options.stop != nullptr && options.stop->load();
    if (comparison.stopped) comparison.changes.clear();  // they would be incomplete
  }
  return comparison;
}

std::string Contender::label() const {
  const std::string name(name_of(mode));
  return gains.empty() ? name : name + " with " + gains;
}

Result<Comparison> compare(const Model& model, const ModeGains& gains,
                           const std::vector<Scenario>& scenarios, const CompareOptions& options) {
  return compare(model, std::vector<NamedGains>{{"", gains}}, scenarios, options);
}

}  // namespace awmr
