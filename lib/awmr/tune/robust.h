/// Draws vehicles from the model's covariance, and evaluates gains on vehicles that the search did
/// not use. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// How vehicles are drawn: independently (PlantSampler::draw), or evenly spread
/// (PlantSampler::draw_evenly).
enum class Spread { kRandom, kEven };

/// Returns the nominal vehicle, then the drawn vehicles 1 to `draws`, with the unmodelled variation
/// `open`. The parameters of the drawn vehicles come from the model's covariance; without a
/// covariance, they are nominal. Errors (input): those of PlantSampler::make(),
/// PlantSampler::draw() and PlantSampler::draw_evenly().
Result<std::vector<DrawnVehicle>> vehicles_of(const Model& model, int draws, std::uint64_t seed,
                                              const UnmodelledVariation& open, Spread spread);

/// Removes the unmodelled variation `open` from drawn vehicles: divides m' and I'z by their mass
/// factors, and restores the model's own wheel-force range. `vehicles`: the first vehicles that
/// vehicles_of() returned with this variation, or with `open` as a part of it.
std::vector<DrawnVehicle> without(const UnmodelledVariation& open,
                                  std::vector<DrawnVehicle> vehicles);

/// Gains to evaluate, with their name in the result (EvaluatedGains::gains).
struct NamedCandidate {
  const char* name;
  Gains<double> gains;
};

/// Simulates every set of gains in every mode and scenario on the drawn vehicles of the setting,
/// without its first vehicle, the nominal one. Replaces the statistics in `robust`.
void evaluate_candidates(const ObjectiveSetting& setting,
                         const std::vector<NamedCandidate>& candidates, RobustTuning& robust);

/// Evaluates the tuned gains and those with which they are compared (EvaluatedGains::gains) on
/// TuneOptions::evaluation_draws newly drawn vehicles. Replaces the statistics in Tuning::robust,
/// which must be present. Errors: those of vehicles_of().
Status evaluate_on_new_vehicles(const Model& model, ObjectiveSetting setting,
                                const TuneOptions& options, Tuning& tuning);

}  // namespace awmr
