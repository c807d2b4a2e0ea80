/// Gains for more than one vehicle: plants drawn from the model's covariance, readings that are noisy
/// and late, motors that lag; and how gains do on draws that they were not tuned on. Private to tune/.
#pragma once

#include <span>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// The model's own plant, then those of the numbers from its covariance; where it has none, its own
/// again. Errors (input): as PlantSampler's.
Result<std::vector<Plant<double>>> plants_of(const Model& model, std::span<const int> numbers,
                                             std::uint64_t seed);
/// Those of 1 to `draws`.
Result<std::vector<Plant<double>>> plants_of(const Model& model, int draws, std::uint64_t seed);

/// Gains with the name that they are judged under.
struct NamedCandidate {
  const char* name;
  Gains<double> gains;
};

/// Every set of gains in every mode over all plants of the setting but the first, the model's own.
std::vector<JudgedRuns> run_candidates(const ObjectiveSetting& setting,
                                       const std::vector<NamedCandidate>& candidates);

struct Judgement {
  std::vector<JudgedGains> gains;  ///< by gains, then mode
  std::vector<JudgedGoal> goals;   ///< by gains, then goal, then mode
};
/// What runs are judged by, beside themselves.
struct JudgedBy {
  std::vector<YawMode> modes;
  std::size_t scenarios = 1;
  double tail_share = 1.0;
  std::vector<TuningGoal> goals;
};
/// Of all draws, each set of gains by itself. A run that does not settle counts as having taken the
/// whole scenario.
Judgement judgement_of(const std::vector<JudgedRuns>& runs, const JudgedBy& by);

}  // namespace awmr
