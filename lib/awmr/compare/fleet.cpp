#include "awmr/compare/fleet.h"

#include <optional>
#include <utility>

#include "awmr/simulate/plant_sampler.h"

namespace awmr {
namespace {

/// The model by sample: as it is, then drawn.
Result<std::vector<Model>> models_by_sample(const Model& model, const CompareOptions& options) {
  std::vector<Model> models{model};
  if (options.samples == 0) return models;
  AWMR_ASSIGN_OR_RETURN(const PlantSampler sampler, PlantSampler::make(model));
  for (int sample = 1; sample <= options.samples; ++sample) {
    AWMR_ASSIGN_OR_RETURN(Model drawn, sampler.draw_model(options.seed, sample));
    models.push_back(std::move(drawn));
  }
  return models;
}

}  // namespace

Result<Fleet> fleet_of(const Model& model, const std::vector<Scenario>& scenarios,
                       const CompareOptions& options) {
  Fleet fleet;
  AWMR_ASSIGN_OR_RETURN(fleet.nominal, model.plant());
  AWMR_ASSIGN_OR_RETURN(const std::vector<Model> models, models_by_sample(model, options));
  std::optional<std::size_t> without_corner;  // all scenarios without a corner share their vehicles
  for (const Scenario& scenario : scenarios) {
    if (scenario.corner.empty() && without_corner) {
      fleet.first.push_back(*without_corner);
      continue;
    }
    fleet.first.push_back(fleet.vehicles.size());
    if (scenario.corner.empty()) without_corner = fleet.first.back();
    for (const Model& one : models) {
      AWMR_ASSIGN_OR_RETURN(const Plant<double> vehicle, plant_for(scenario, one));
      fleet.vehicles.push_back(vehicle);
    }
  }
  return fleet;
}

}  // namespace awmr
