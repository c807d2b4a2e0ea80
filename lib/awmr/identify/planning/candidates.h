/// The trials that could be recorded next, each with what it would measure. Private to this folder.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/planning/suggest.h"

namespace awmr {

struct CandidateTrial {
  SuggestedTrial trial;  ///< kind, settings and numbers; its standard errors are still to be found
  /// What the trial would measure on a plant, each number over the standard deviation of its error:
  /// as many numbers for every plant.
  std::function<std::vector<double>(const Plant<double>&)> standardised;
};

/// Those whose motion the model knows; a log of one that knows straight motion alone drives straight.
std::vector<CandidateTrial> candidates_of(const Model& model, const SuggestOptions& options);

struct ScrubPlan {
  std::vector<ScrubTurn> turns;
  std::string about;
};
/// Turns by the sides at a third, two thirds and all of the fastest turn that yaw resistance was measured
/// at, about the force that drives straight at half the fastest speed: as far as the wheels' forces reach.
ScrubPlan scrub_plan(const Model& model);

/// At half of the fastest speed of the trials, or of the motors, and half of the steering's stop, less where
/// tyres of little friction would slide.
std::optional<CoastingTurn> coasting_turn(const Model& model);

/// What is assumed of the errors of the candidates' measurements, in words.
std::vector<std::string> assumptions_of(const Model& model, const SuggestOptions& options);

}  // namespace awmr
