/// Candidate trials to record next, each with its predicted measurements. Private to this folder.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/planning/suggest.h"

namespace awmr {

struct CandidateTrial {
  SuggestedTrial trial;  ///< kind, settings and numbers; its standard errors are still to be found
  /// Predicted measurements of the trial on a plant, each divided by the standard deviation of its
  /// error. Their number is the same for every plant.
  std::function<std::vector<double>(const Plant<double>&)> standardised;
};

/// Trials whose motion the model covers; for a model of straight motion the logs drive straight.
std::vector<CandidateTrial> candidates_of(const Model& model, const SuggestOptions& options);

struct ScrubPlan {
  std::vector<ScrubTurn> turns;
  std::string about;
};
/// Differential turns at a third, two thirds and all of the highest measured yaw rate, about the
/// force that drives straight at half the highest speed, within the limits of the wheel forces.
ScrubPlan scrub_plan(const Model& model);

/// At half of the fastest speed of the trials, or of the motors, and half of the steering's stop, less where
/// tyres of little friction would slide.
std::optional<CoastingTurn> coasting_turn(const Model& model);

/// Description of the assumed measurement errors of the candidates.
std::vector<std::string> assumptions_of(const Model& model, const SuggestOptions& options);

}  // namespace awmr
