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

/// The model's own vehicle, then those of the numbers (from 1) from its covariance, or its own
/// again where it has none; each with its unmodelled variation. Errors (input): as PlantSampler's.
Result<std::vector<DrawnVehicle>> vehicles_of(const Model& model, std::span<const int> numbers,
                                              std::uint64_t seed, const OpenVehicle& open);
/// Draws 1 to `draws`, spread evenly (PlantSampler::draw_evenly).
Result<std::vector<DrawnVehicle>> vehicles_of(const Model& model, int draws, std::uint64_t seed,
                                              const OpenVehicle& open);

/// Gains with the name that they are evaluated under.
struct NamedCandidate {
  const char* name;
  Gains<double> gains;
};

/// Every set of gains in every mode over all vehicles of the setting but the first, the model's own.
std::vector<JudgedRuns> run_candidates(const ObjectiveSetting& setting,
                                       const std::vector<NamedCandidate>& candidates);

struct Judgement {
  std::vector<JudgedGains> gains;  ///< by gains, then mode
  std::vector<JudgedGains>
      by_scenario;                ///< by scenario, then gains, then mode; empty where there is one
  std::vector<JudgedGoal> goals;  ///< by gains, then goal, then mode
};
/// Criteria of the runs.
struct JudgedBy {
  std::vector<YawMode> modes;
  std::vector<std::string> scenarios;  ///< by name, in the runs' order
  double tail_share = 1.0;
  std::vector<TuningGoal> goals;
};
/// Statistics over all draws, for each set of gains. A run that does not settle counts as the whole
/// duration.
Judgement judgement_of(const std::vector<JudgedRuns>& runs, const JudgedBy& by);

}  // namespace awmr
