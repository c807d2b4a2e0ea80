/// Gains for more than one vehicle: plants drawn from the model's covariance, readings that are noisy
/// and late, motors that lag; and how gains do on draws that they were not tuned on. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// The model's own plant, then `draws` ones from its covariance; where it has none, its own again.
/// Errors (input): as PlantSampler's.
Result<std::vector<Plant<double>>> plants_of(const Model& model, int draws, std::uint64_t seed);

/// Gains with the name that they are judged under.
struct NamedCandidate {
  const char* name;
  Gains<double> gains;
};

struct Judgement {
  std::vector<JudgedGains> gains;  ///< by gains, then mode
  std::vector<JudgedGoal> goals;   ///< by gains, then goal, then mode
};
/// Every set of gains in every mode over all plants of the setting but the first, the model's own.
/// A run that does not settle counts as having taken the whole scenario.
Judgement judge(const ObjectiveSetting& setting, const std::vector<NamedCandidate>& candidates);

}  // namespace awmr
