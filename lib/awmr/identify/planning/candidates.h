/// Candidate trials to record next, each with its predicted measurements. Private to this folder.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/planning/suggest.h"

namespace awmr {

struct CandidateTrial {
  SuggestedTrial trial;  ///< kind, settings and numbers; its standard errors are not set
  /// Predicted measurements of the trial on a plant, each divided by the standard deviation of its
  /// error. The number of measurements is the same for every plant.
  std::function<std::vector<double>(const Plant<double>&)> standardised;
};

/// Trials within the model's validity; for a model of straight motion the logs drive straight.
std::vector<CandidateTrial> candidates_of(const Model& model, const SuggestOptions& options);

struct ScrubPlan {
  std::vector<ScrubTurn> turns;
  std::string about;
};
/// Differential turns at 1/3, 2/3 and 1 times the highest measured yaw rate. The mean wheel force
/// is that of straight driving at half the highest speed. Forces are within the limits of the
/// wheels.
ScrubPlan scrub_plan(const Model& model);

/// At half of the highest speed of the trials or the motors and half of the largest steering angle;
/// less if tyres with little friction would slide.
std::optional<CoastingTurn> coasting_turn(const Model& model);

/// Description of the assumed measurement errors of the candidates.
std::vector<std::string> assumptions_of(const Model& model, const SuggestOptions& options);

}  // namespace awmr
