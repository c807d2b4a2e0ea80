#include "awmr/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <set>
#include <utility>

#include "awmr/compare/fleet.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/parallel.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

void check_shard(const CompareOptions& options, std::vector<Fault>& faults) {
  const Shard& shard = options.shard;
  const bool is_part =
      shard.index >= 1 && shard.index <= shard.count && shard.count <= options.samples + 1L;
  if (options.samples >= 0 && !is_part) {
    faults.push_back({option_text("shard"),
                      fmt::format("{}/{} is no part: I/N with 1 <= I <= N, and N at most the {} "
                                  "samples, the nominal one included",
                                  shard.index, shard.count, options.samples + 1L)});
  }
}

std::vector<Fault> option_faults(const std::vector<NamedGains>& gains,
                                 const std::vector<Scenario>& scenarios,
                                 const CompareOptions& options) {
  std::vector<Fault> faults;
  if (options.samples < 0) {
    faults.push_back(
        {option_text("samples"), fmt::format("has to be 0 or more, found {}", options.samples)});
  }
  if (options.threads < 0) {
    faults.push_back(
        {option_text("threads"), fmt::format("has to be 0 or more, found {}", options.threads)});
  }
  check_shard(options, faults);
  if (scenarios.empty()) {
    faults.push_back({option_text("scenario"), "none given; give at least one"});
  }
  std::set<std::string> names;
  for (const Scenario& scenario : scenarios) {
    if (!names.insert(scenario.name).second) {
      faults.push_back(
          {option_text("scenario"), fmt::format("two scenarios are named '{}'; the rows could "
                                                "not be told apart: rename one",
                                                scenario.name)});
    }
  }
  std::set<std::string> sets;
  for (const NamedGains& set : gains) {
    if (!sets.insert(set.name).second) {
      faults.push_back(
          {option_text("gains"), fmt::format("two sets of gains are named '{}'", set.name)});
    }
  }
  if (gains.empty()) faults.push_back({option_text("gains"), "none given; give at least one"});
  return faults;
}

/// What is run: positions in the lists of scenarios, gains and kYawModes, and the sample.
struct Place {
  std::size_t scenario, gains, mode, sample;
};

struct Layout {
  std::size_t scenarios, gains, modes, samples;

  std::size_t count() const { return scenarios * gains * modes * samples; }
  /// The place of a row in the output, which is sorted by scenario, gains, mode and sample.
  std::size_t row(const Place& p) const {
    return ((p.scenario * gains + p.gains) * modes + p.mode) * samples + p.sample;
  }
  /// Runs are begun by sample, scenario, gains, mode: a comparison that is stopped has whole
  /// samples.
  Place in_running_order(std::size_t i) const {
    return {.scenario = i / (gains * modes) % scenarios,
            .gains = i / modes % gains,
            .mode = i % modes,
            .sample = i / (scenarios * gains * modes)};
  }
};

/// A place for each row of the output, empty until its run is finished.
using Slots = std::vector<std::optional<ComparisonRow>>;

template <class Items, class Same>
std::optional<std::size_t> position_of(const Items& items, const Same& same) {
  const auto found = std::find_if(std::begin(items), std::end(items), same);
  if (found == std::end(items)) return std::nullopt;
  return at(found - std::begin(items));
}

Status take_finished(const std::vector<Scenario>& scenarios, const std::vector<NamedGains>& gains,
                     const CompareOptions& options, const Layout& layout, Slots& slots) {
  for (const ComparisonRow& row : options.finished) {
    const auto scenario =
        position_of(scenarios, [&](const Scenario& other) { return other.name == row.scenario; });
    const auto set =
        position_of(gains, [&](const NamedGains& other) { return other.name == row.gains; });
    const auto mode = position_of(kYawModes, [&](YawMode other) { return other == row.mode; });
    if (!scenario || !set || !mode || *mode >= layout.modes || row.sample < 0) {
      return input_error(option_text("resume"),
                         fmt::format("the finished run of '{}' in sample {} is none of this "
                                     "comparison's; compare into another directory",
                                     row.scenario, row.sample));
    }
    if (at(row.sample) >= layout.samples) continue;  // fewer samples are asked for now
    slots[layout.row({*scenario, *set, *mode, at(row.sample)})] = row;
  }
  return {};
}

/// Errors (input): as failure_of.
Result<ComparisonRow> run_of(const Vehicle& vehicle, const Fleet& fleet, const NamedGains& set,
                             const Scenario& scenario, const Place& place, std::uint64_t seed) {
  // The controller knows the model's own values, not the drawn ones.
  const Controller<double> controller = make_controller(fleet.nominal, vehicle, set.gains);
  const YawMode mode = kYawModes[place.mode];
  // Sample 0 is the run of `awmr simulate`: the scenario's seed alone.
  const Run run = simulate(fleet.vehicle(place.scenario, place.sample), controller, scenario, mode,
                           {.sample_time_s = vehicle.sample_time_s,
                            .substeps = {},
                            .seed = place.sample == 0 ? 0 : seed,
                            .sample = place.sample});
  AWMR_RETURN_IF_ERROR(failure_of(run, scenario));
  return ComparisonRow{.scenario = scenario.name,
                       .mode = mode,
                       .sample = static_cast<int>(place.sample),
                       .metrics = metrics_of(run, scenario, controller),
                       .gains = set.name};
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
  AWMR_ASSIGN_OR_RETURN(const Fleet fleet, fleet_of(model, scenarios, options));

  const Layout layout{scenarios.size(), gains.size(), yaw_modes(model.vehicle).size(),
                      at(options.samples) + 1};
  Slots slots(layout.count());
  AWMR_RETURN_IF_ERROR(take_finished(scenarios, gains, options, layout, slots));

  std::vector<Status> failures(layout.count());
  std::atomic<std::size_t> done = 0;
  LoopControl control;
  if (options.stop != nullptr) control.stop = [&] { return options.stop->load(); };
  if (options.progress) control.progress = [&] { options.progress(done, layout.count()); };
  // Each run owns one slot, so the order in which threads take them leaves no trace.
  parallel_for(
      layout.count(), options.threads,
      [&](std::size_t i) {
        const Place place = layout.in_running_order(i);
        const std::size_t index = layout.row(place);
        if (!slots[index] && options.shard.has(static_cast<int>(place.sample))) {
          auto row = run_of(model.vehicle, fleet, gains[place.gains], scenarios[place.scenario],
                            place, options.seed);
          if (row) {
            slots[index] = std::move(*row);
          } else {
            failures[index] = tl::unexpected(row.error());
          }
        }
        ++done;
      },
      control);
  for (const Status& failure : failures) AWMR_RETURN_IF_ERROR(failure);
  return gathered(layout, options.shard, std::move(slots));
}

Result<Comparison> compare(const Model& model, const Gains<double>& gains,
                           const std::vector<Scenario>& scenarios, const CompareOptions& options) {
  return compare(model, std::vector<NamedGains>{{"", gains}}, scenarios, options);
}

}  // namespace awmr
