#include "awmr/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "awmr/compare/break_even.h"
#include "awmr/compare/decision.h"
#include "awmr/compare/sampled_plants.h"
#include "awmr/compare/shared_noise.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/parallel.h"
#include "awmr/model/fitted_law.h"
#include "awmr/simulate/batch.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

std::vector<Fault> option_faults(const std::vector<NamedGains>& gains,
                                 const std::vector<Scenario>& scenarios,
                                 const CompareOptions& options) {
  std::vector<Fault> faults;
  if (options.samples < 0) {
    faults.push_back({ErrorCode::kOutOfRange, option_text("samples"),
                      fmt::format("has to be 0 or more, found {}", options.samples)});
  }
  if (options.threads < 0) {
    faults.push_back({ErrorCode::kOutOfRange, option_text("threads"),
                      fmt::format("has to be 0 or more, found {}", options.threads)});
  }
  if (options.samples >= 0) {
    auto fault =
        shard_fault(options.shard, options.samples + 1L, "samples, the nominal one included");
    if (fault) faults.push_back(std::move(*fault));
  }
  if (scenarios.empty()) {
    faults.push_back(
        {ErrorCode::kMissing, option_text("scenario"), "none given; give at least one"});
  }
  std::set<std::string> names;
  for (const Scenario& scenario : scenarios) {
    if (!names.insert(scenario.name).second) {
      faults.push_back({ErrorCode::kGivenTwice, option_text("scenario"),
                        fmt::format("two scenarios are named '{}', so their rows "
                                    "could not be distinguished; rename one",
                                    scenario.name)});
    }
  }
  for (const Scenario& scenario : scenarios) {
    if (options.break_even && scenario.tyres) {
      faults.push_back(
          {ErrorCode::kConflict, option_text("break_even"),
           fmt::format("varies the scrub moment of the 3-DOF model, but scenario '{}' is on the "
                       "four-wheel plant; leave the option out, or use --plant model",
                       scenario.name)});
    }
  }
  std::set<std::string> sets;
  for (const NamedGains& set : gains) {
    if (!sets.insert(set.name).second) {
      faults.push_back(
          {ErrorCode::kGivenTwice, option_text("gains"),
           fmt::format("two sets of gains are named '{}'; rename one file", set.name)});
    }
  }
  if (options.break_even && gains.size() > 1) {
    faults.push_back(
        {ErrorCode::kConflict, option_text("break_even"),
         fmt::format("needs one set of gains, found {}; remove the others", gains.size())});
  }
  if (options.break_even && options.shard.count > 1) {
    faults.push_back(
        {ErrorCode::kConflict, option_text("break_even"),
         fmt::format("cannot be combined with {}; remove one of them", option_text("shard"))});
  }
  if (gains.empty()) {
    faults.push_back({ErrorCode::kMissing, option_text("gains"), "none given; give at least one"});
  }
  return faults;
}

/// Checks the number of runs, before memory is allocated for the samples. Error (input): more than
/// kMaxRuns runs. `per_sample`: number of runs of each sample.
Status check_runs(std::size_t per_sample, int samples) {
  const std::size_t most = kMaxRuns / per_sample;
  if (at(samples) + 1 <= most) return {};
  return input_error(
      ErrorCode::kTooLarge, option_text("samples"),
      fmt::format("{} samples and the nominal one, in {} runs each, are {:.3g} runs, more than the "
                  "limit of {}; give at most {} samples, or fewer scenarios or sets of gains",
                  samples, per_sample, (samples + 1.0) * static_cast<double>(per_sample), kMaxRuns,
                  most > 0 ? most - 1 : 0));
}

/// Identifies a run by its indices in the lists of scenarios, gains and kYawModes, and its sample.
struct Place {
  std::size_t scenario, gains, mode, sample;
};

struct Layout {
  std::size_t scenarios, gains, modes, samples;

  std::size_t count() const { return scenarios * gains * modes * samples; }
  /// Index of a row in the output, which is sorted by scenario, gains, mode and sample.
  std::size_t row(const Place& p) const {
    return ((p.scenario * gains + p.gains) * modes + p.mode) * samples + p.sample;
  }
};

/// One entry per row of the output, empty until its run is finished.
using Slots = std::vector<std::optional<ComparisonRow>>;

/// Longest run, in samples, whose noise is drawn in advance and shared. The noise takes 24 bytes
/// per sample and run, up to 38 MB for a batch.
constexpr double kMaxSharedNoise = 1e5;

/// A batch of runs: one scenario, set of gains and mode, with the samples to run.
struct Block {
  std::size_t scenario, gains, mode;
  std::vector<std::size_t> samples;
  /// Shared by all blocks of these samples in the scenario.
  std::shared_ptr<SharedNoise> noise;

  Place place(std::size_t i) const { return {scenario, gains, mode, samples[i]}; }
};

/// Divides the samples of this part into blocks of kBatchRuns. The blocks of the same samples in
/// all scenarios, gains and modes are consecutive, so that a stopped comparison has complete
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
    // Sample 0 has seed 0, so that its run equals that of `awmr simulate`, which uses only the seed
    // of the scenario.
    runs.push_back({plants.vehicle(block.scenario, sample), controller, mode,
                    sample == 0 ? 0 : seed, static_cast<std::uint64_t>(sample)});
  }
  return runs;
}

/// Draws the noise of the block's runs, or takes it from another block with the same samples (in
/// another mode or with other gains) that has drawn it.
void share_noise(const Scenario& scenario, double sample_time_s, const Block& block,
                 std::vector<BatchRun>& runs) {
  if (scenario.duration_s / sample_time_s > kMaxSharedNoise) return;
  const auto& drawn = block.noise->drawn([&] {
    SharedNoise::Drawn noise;
    for (const BatchRun& run : runs) {
      noise[run.sample] = draw_sensor_noise(scenario, sample_time_s, run.seed, run.sample);
    }
    return noise;
  });
  for (BatchRun& run : runs) {
    const auto found = drawn.find(run.sample);
    if (found != drawn.end()) run.noise = &found->second;
  }
}

/// Runs a block. Stores each result at its row's index in `slots`, or the error in `failures`.
void run_block(const Model& model, const std::vector<NamedGains>& gains,
               const std::vector<Scenario>& scenarios, std::uint64_t seed,
               const SampledPlants& plants, const BatchArithmetic& arithmetic, const Layout& layout,
               const Block& block, Slots& slots, std::vector<Status>& failures) {
  const Scenario& scenario = scenarios[block.scenario];
  const NamedGains& set = gains[block.gains];
  // The controller has the nominal values, not the drawn ones.
  const auto controller = make_controller(plants.nominal, model.vehicle, set.gains);
  const YawMode mode = kYawModes[block.mode];
  std::vector<BatchRun> runs = runs_of(plants, controller, block, mode, seed);
  share_noise(scenario, model.vehicle.sample_time_s, block, runs);
  auto metrics = simulate_batch(runs, scenario, model.vehicle.sample_time_s, arithmetic);
  block.noise->remove_user();
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const std::size_t index = layout.row(block.place(i));
    if (!metrics[i]) {
      failures[index] = tl::unexpected(metrics[i].error());
      continue;
    }
    metrics[i]->electric_work_j =
        electric_work_j(*metrics[i], model.vehicle, runs[i].plant.mass_norm);
    slots[index] = ComparisonRow{.scenario = scenario.name,
                                 .mode = mode,
                                 .sample = static_cast<int>(block.samples[i]),
                                 .metrics = *metrics[i],
                                 .gains = set.name};
  }
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
                           const std::vector<Scenario>& scenarios, const CompareOptions& options) {
  std::vector<Fault> faults = option_faults(gains, scenarios, options);
  if (!faults.empty()) return input_errors(std::move(faults));
  AWMR_RETURN_IF_ERROR(check_runs(scenarios.size() * gains.size() * yaw_modes(model.vehicle).size(),
                                  options.samples));
  for (const NamedGains& set : gains) AWMR_RETURN_IF_ERROR(controller_for(model, set.gains));
  AWMR_ASSIGN_OR_RETURN(const SampledPlants plants, sample_plants(model, scenarios, options));
  AWMR_ASSIGN_OR_RETURN(const BatchArithmetic arithmetic, batch_arithmetic());

  const Layout layout{scenarios.size(), gains.size(), yaw_modes(model.vehicle).size(),
                      at(options.samples) + 1};
  Slots slots(layout.count());
  const std::vector<Block> blocks = blocks_of(layout, options.shard);
  std::vector<Status> failures(layout.count());
  std::atomic<std::size_t> done = 0;
  LoopControl control;
  if (options.stop != nullptr) control.stop = [&] { return options.stop->load(); };
  if (options.progress) control.progress = [&] { options.progress(done, layout.count()); };
  // Each run has its own entry, so the result does not depend on the order of the threads.
  parallel_for(
      blocks.size(), options.threads,
      [&](std::size_t b) {
        run_block(model, gains, scenarios, options.seed, plants, arithmetic, layout, blocks[b],
                  slots, failures);
        done += blocks[b].samples.size();
      },
      control);
  for (const Status& failure : failures) AWMR_RETURN_IF_ERROR(failure);
  Comparison comparison = gathered(layout, options.shard, std::move(slots));
  comparison.arithmetic = arithmetic.rounding;
  comparison.measured_yaw_rate_degps = measured_yaw_rate_degps(model);
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

Result<Comparison> compare(const Model& model, const Gains<double>& gains,
                           const std::vector<Scenario>& scenarios, const CompareOptions& options) {
  return compare(model, std::vector<NamedGains>{{"", gains}}, scenarios, options);
}

}  // namespace awmr
