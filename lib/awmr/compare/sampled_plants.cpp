#include "awmr/compare/sampled_plants.h"

#include <optional>

#include "awmr/core/index.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

/// Returns the scenarios for which vehicles must be made. A scenario with a corner (parameters
/// moved to the ends of their intervals) has its own vehicles. All scenarios without a corner use
/// the vehicles of the first such scenario. `first` receives for each scenario the index of its
/// first vehicle.
std::vector<const Scenario*> apart(const std::vector<Scenario>& scenarios, std::size_t samples,
                                   std::vector<std::size_t>& first) {
  std::vector<const Scenario*> own;
  std::optional<std::size_t> without_corner;
  for (const Scenario& scenario : scenarios) {
    if (scenario.corner.empty() && without_corner) {
      first.push_back(*without_corner);
      continue;
    }
    first.push_back(own.size() * samples);
    if (scenario.corner.empty()) without_corner = first.back();
    own.push_back(&scenario);
  }
  return own;
}

}  // namespace

Result<SampledPlants> sample_plants(const Model& model, const std::vector<Scenario>& scenarios,
                                    const CompareOptions& options) {
  const std::size_t samples = at(options.samples) + 1;
  // Checked with the nominal model, which the controller uses in all samples.
  for (const Scenario& scenario : scenarios) AWMR_RETURN_IF_ERROR(check_scenario(scenario, model));
  SampledPlants plants;
  AWMR_ASSIGN_OR_RETURN(plants.nominal, model.plant());
  const std::vector<const Scenario*> own = apart(scenarios, samples, plants.first);
  plants.vehicles.resize(own.size() * samples);
  std::optional<PlantSampler> sampler;
  if (options.samples > 0) {
    AWMR_ASSIGN_OR_RETURN(sampler, PlantSampler::make(model));
  }
  for (std::size_t sample = 0; sample < samples; ++sample) {
    Model drawn = model;
    if (sample > 0) {
      AWMR_ASSIGN_OR_RETURN(drawn, sampler->draw_model(options.seed, static_cast<int>(sample)));
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
      AWMR_ASSIGN_OR_RETURN(const Model corner, model_at_corner(drawn, *own[i]));
      AWMR_ASSIGN_OR_RETURN(plants.vehicles[i * samples + sample], corner.plant());
    }
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
      AWMR_RETURN_IF_ERROR(check_work(plants.vehicle(i, sample), model.file, scenarios[i],
                                      model.vehicle.sample_time_s));
    }
  }
  return plants;
}

}  // namespace awmr
