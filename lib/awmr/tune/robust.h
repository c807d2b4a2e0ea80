/// Draws vehicles from the model's covariance, and evaluates gains on vehicles that the search did
/// not use. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/drawn_vehicle.h"
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

/// Gains to evaluate, with their name in the result (EvaluatedGains::gains).
struct NamedCandidate {
  const char* name;
  Gains<double> gains;
};

/// Simulates every set of gains in every mode and scenario on the drawn vehicles of the setting,
/// without its first vehicle, the nominal one.
std::vector<EvaluatedRuns> run_candidates(const ObjectiveSetting& setting,
                                          const std::vector<NamedCandidate>& candidates);

struct EvaluationResult {
  std::vector<EvaluatedGains> gains;  ///< statistics over all scenarios, by gains, then mode
  /// Statistics for each scenario alone, sorted by scenario, then gains, then mode. Empty with a
  /// single scenario.
  std::vector<EvaluatedGains> by_scenario;
  /// Share of the vehicles that meet each goal, sorted by gains, then goal, then mode.
  std::vector<EvaluatedGoal> goals;
};
/// Properties of the runs that evaluation_of() needs.
struct EvaluationSetup {
  std::vector<YawMode> modes;
  std::vector<std::string> scenarios;  ///< names of the scenarios, in the order of the runs
  /// Share of the draws in the tail, over which EvaluatedFigure::tail_mean is the mean, (0, 1].
  double tail_share = 1.0;
  std::vector<TuningGoal> goals;
};
/// Computes the statistics over all drawn vehicles for each set of gains.
EvaluationResult evaluation_of(const std::vector<EvaluatedRuns>& runs, const EvaluationSetup& by);

}  // namespace awmr
