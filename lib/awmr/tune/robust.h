/// Gains for more than one vehicle: plants drawn from the model's covariance, sensor noise and
/// latency, motor lag; and the evaluation of gains on draws that they were not tuned on. Private to
/// tune/.
#pragma once

#include <span>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/drawn_vehicle.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// The nominal vehicle, then the draws with these numbers (from 1), each with its unmodelled
/// variation. A draw is from the model's covariance, or nominal without one. Errors (input): as
/// PlantSampler's.
Result<std::vector<DrawnVehicle>> vehicles_of(const Model& model, std::span<const int> numbers,
                                              std::uint64_t seed, const UnmodelledVariation& open);
/// Draws 1 to `draws`, spread evenly (PlantSampler::draw_evenly).
Result<std::vector<DrawnVehicle>> vehicles_of(const Model& model, int draws, std::uint64_t seed,
                                              const UnmodelledVariation& open);

/// Gains with a name for the evaluation.
struct NamedCandidate {
  const char* name;
  Gains<double> gains;
};

/// Evaluates every set of gains in every mode over all vehicles of the setting except the first,
/// which is nominal.
std::vector<EvaluatedRuns> run_candidates(const ObjectiveSetting& setting,
                                          const std::vector<NamedCandidate>& candidates);

struct EvaluationResult {
  std::vector<EvaluatedGains> gains;  ///< by gains, then mode
  std::vector<EvaluatedGains>
      by_scenario;  ///< by scenario, then gains, then mode; empty with a single scenario
  std::vector<EvaluatedGoal> goals;  ///< by gains, then goal, then mode
};
/// Criteria of the runs.
struct EvaluationSetup {
  std::vector<YawMode> modes;
  std::vector<std::string> scenarios;  ///< by name, in the runs' order
  double tail_share = 1.0;
  std::vector<TuningGoal> goals;
};
/// Statistics over all draws, for each set of gains. The settling time of a run that does not
/// settle is the scenario's duration.
EvaluationResult evaluation_of(const std::vector<EvaluatedRuns>& runs, const EvaluationSetup& by);

}  // namespace awmr
