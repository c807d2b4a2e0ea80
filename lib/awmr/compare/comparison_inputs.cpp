#include "awmr/compare/comparison_inputs.h"

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

void check_numbers(const CompareOptions& options, std::vector<Fault>& faults) {
  for (const auto& [name, number] :
       {std::pair("samples", options.samples), std::pair("threads", options.threads)}) {
    if (number >= 0) continue;
    faults.push_back({ErrorCode::kOutOfRange, option_text(name),
                      fmt::format("has to be 0 or more, found {}", number)});
  }
  if (auto fault = relevance_fault(options.preferences.relevance)) {
    faults.push_back(*std::move(fault));
  }
  if (options.samples < 0) return;
  auto fault =
      shard_fault(options.shard, options.samples + 1L, "samples, the nominal one included");
  if (fault) faults.push_back(std::move(*fault));
}

void check_scenarios(const std::vector<Scenario>& scenarios, bool break_even,
                     std::vector<Fault>& faults) {
  if (scenarios.empty()) {
    faults.push_back(
        {ErrorCode::kMissing, option_text("scenario"), "none given; give at least one"});
  }
  std::set<std::string> names;
  for (const Scenario& scenario : scenarios) {
    if (names.insert(scenario.name).second) continue;
    faults.push_back({ErrorCode::kGivenTwice, option_text("scenario"),
                      fmt::format("two scenarios are named '{}', so their rows "
                                  "could not be distinguished; rename one",
                                  scenario.name)});
  }
  for (const Scenario& scenario : scenarios) {
    if (!break_even || !scenario.tyres) continue;
    faults.push_back(
        {ErrorCode::kConflict, option_text("break_even"),
         fmt::format("the break-even analysis varies the scrub moment of the 3-DOF model, but "
                     "scenario '{}' is on the four-wheel plant; leave the option out, or use "
                     "--plant model",
                     scenario.name)});
  }
}

void check_gains(const std::vector<NamedGains>& gains, const CompareOptions& options,
                 std::vector<Fault>& faults) {
  std::set<std::string> names;
  for (const NamedGains& set : gains) {
    if (names.insert(set.name).second) continue;
    faults.push_back({ErrorCode::kGivenTwice, option_text("gains"),
                      fmt::format("two sets of gains are named '{}'; rename one file", set.name)});
  }
  if (options.break_even && gains.size() > 1) {
    faults.push_back(
        {ErrorCode::kConflict, option_text("break_even"),
         fmt::format(
             "the break-even analysis needs one set of gains, found {} sets; remove the other sets",
             gains.size())});
  }
  if (options.break_even && options.shard.count > 1) {
    faults.push_back(
        {ErrorCode::kConflict, option_text("break_even"),
         fmt::format("cannot be combined with {}; remove one of them", option_text("shard"))});
  }
  if (gains.empty()) {
    faults.push_back({ErrorCode::kMissing, option_text("gains"), "none given; give at least one"});
  }
}

/// Checks the number of runs before memory is allocated for their results. Error (input): more than
/// kMaxRuns runs. `per_sample`: number of runs of each sample.
Status check_runs(std::size_t per_sample, int samples) {
  const std::size_t most = kMaxRuns / per_sample;
  if (at(samples) + 1 <= most) return {};
  return input_error(
      ErrorCode::kTooLarge, option_text("samples"),
      fmt::format("{} samples and the nominal model, with {} runs each, are {:.3g} runs, more than "
                  "the limit of {}; give at most {} samples, or fewer scenarios or sets of gains",
                  samples, per_sample, (samples + 1.0) * static_cast<double>(per_sample), kMaxRuns,
                  most > 0 ? most - 1 : 0));
}

}  // namespace

Status check_comparison(const Model& model, const std::vector<NamedGains>& gains,
                        const std::vector<Scenario>& scenarios, const CompareOptions& options) {
  std::vector<Fault> faults;
  check_numbers(options, faults);
  check_scenarios(scenarios, options.break_even, faults);
  check_gains(gains, options, faults);
  if (!faults.empty()) return input_errors(std::move(faults));
  AWMR_RETURN_IF_ERROR(check_runs(scenarios.size() * gains.size() * yaw_modes(model.vehicle).size(),
                                  options.samples));
  for (const NamedGains& set : gains) {
    for (const YawMode mode : kYawModes) {
      AWMR_RETURN_IF_ERROR(controller_for(model, set.gains.in(mode)));
    }
  }
  return {};
}

Result<SampledPlants> sample_plants(const Model& model, const std::vector<Scenario>& scenarios,
                                    const CompareOptions& options) {
  // Checked with the nominal model, which the controller uses in all samples.
  for (const Scenario& scenario : scenarios) AWMR_RETURN_IF_ERROR(check_scenario(scenario, model));
  SampledPlants plants{.nominal = {}, .vehicles = {}, .samples = at(options.samples) + 1};
  AWMR_ASSIGN_OR_RETURN(plants.nominal, model.plant());
  plants.vehicles.resize(scenarios.size() * plants.samples);
  std::optional<PlantSampler> sampler;
  if (options.samples > 0) {
    AWMR_ASSIGN_OR_RETURN(sampler, PlantSampler::make(model));
  }
  for (std::size_t sample = 0; sample < plants.samples; ++sample) {
    Model drawn = model;
    if (sample > 0) {
      AWMR_ASSIGN_OR_RETURN(drawn, sampler->draw_model(options.seed, static_cast<int>(sample)));
    }
    AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, drawn.plant());
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
      Plant<double>& vehicle = plants.vehicles[i * plants.samples + sample];
      vehicle = plant;
      if (!scenarios[i].corner.empty()) {
        AWMR_ASSIGN_OR_RETURN(const Model corner, model_at_corner(drawn, scenarios[i]));
        AWMR_ASSIGN_OR_RETURN(vehicle, corner.plant());
      }
      AWMR_RETURN_IF_ERROR(
          check_work(vehicle, model.file, scenarios[i], model.vehicle.sample_time_s));
    }
  }
  return plants;
}

}  // namespace awmr
