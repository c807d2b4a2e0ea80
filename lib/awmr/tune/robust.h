/// Vehicles drawn from the model's covariance, and the evaluation of gains on draws that they were
/// not tuned on. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/drawn_vehicle.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Distribution of draws: independent (PlantSampler::draw), or spread evenly
/// (PlantSampler::draw_evenly).
enum class Spread { kRandom, kEven };

/// Returns the nominal vehicle, then the draws 1 to `draws`, each with its unmodelled variation.
/// The parameters of a draw come from the model's covariance; without a covariance, they are
/// nominal. Errors (input): those of PlantSampler::make(), PlantSampler::draw() and
/// PlantSampler::draw_evenly().
Result<std::vector<DrawnVehicle>> vehicles_of(const Model& model, int draws, std::uint64_t seed,
                                              const UnmodelledVariation& open, Spread spread);

/// Gains to evaluate, with their name in the result (EvaluatedGains::gains).
struct NamedCandidate {
  const char* name;
  Gains<double> gains;
};

/// Simulates every set of gains in every mode and scenario, on each vehicle of the setting except
/// the first, which is the nominal one.
std::vector<EvaluatedRuns> run_candidates(const ObjectiveSetting& setting,
                                          const std::vector<NamedCandidate>& candidates);

struct EvaluationResult {
  std::vector<EvaluatedGains> gains;  ///< over all scenarios, by gains, then mode
  /// By scenario, then gains, then mode; empty with a single scenario.
  std::vector<EvaluatedGains> by_scenario;
  std::vector<EvaluatedGoal> goals;  ///< by gains, then goal, then mode
};
/// Modes, scenarios, tail share and goals for evaluation_of().
struct EvaluationSetup {
  std::vector<YawMode> modes;
  std::vector<std::string> scenarios;  ///< names, in the order of the runs
  double tail_share = 1.0;             ///< share of the draws in EvaluatedFigure::tail_mean, (0, 1]
  std::vector<TuningGoal> goals;
};
/// Computes the statistics over all draws, for each set of gains.
EvaluationResult evaluation_of(const std::vector<EvaluatedRuns>& runs, const EvaluationSetup& by);

}  // namespace awmr
