/// Candidate trials for `awmr suggest`, with their predicted measurements. Private to
/// identify/planning/.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "awmr/identify/planning/suggest.h"

namespace awmr {

/// A trial that could be recorded next.
struct CandidateTrial {
  /// Kind and settings of the trial. Its standard errors are not set yet.
  SuggestedTrial trial;
  /// Predicts the measurements of the trial on a plant. Each measurement is divided by the standard
  /// deviation of its error. Every plant gives the same number of measurements.
  std::function<std::vector<double>(const Plant<double>&)> standardised;
};

/// All candidates within the limits of the wheel forces and the steering that the model can
/// simulate. If the model has only parameters of straight motion, the candidate logs drive
/// straight.
std::vector<CandidateTrial> candidates_of(const Model& model, const SuggestOptions& options);

/// Differential turns to record for the tyre scrub.
struct ScrubPlan {
  std::vector<ScrubTurn> turns;
  std::string about;  ///< see Suggestion::about_scrub
};
/// Plans differential turns that measure the tyre scrub, the yaw moment that it takes to drag the
/// tyres sideways. The yaw rates are 1/3, 2/3 and 1 times the highest measured one, or
/// yaw_rate_max_degps if the vehicle file gives it. The mean wheel force is that of straight
/// driving at half the highest speed of the surge trials; without these, the middle of the force
/// range. Leaves out a turn if the wheel forces do not suffice even for the smallest possible scrub
/// moment.
ScrubPlan scrub_plan(const Model& model);

/// Plans a turn with the motors off (CoastingTurn in suggest.h). Speed: half of the highest speed
/// of the surge trials, or without them half of the steady speed at full force. Steering angle:
/// half of the largest one, or less, so that the lateral acceleration is at most 0.2 g. Empty
/// without steering or surge resistance.
std::optional<CoastingTurn> coasting_turn(const Model& model);

/// Describes the measurement errors that the candidates assume.
std::vector<std::string> assumptions_of(const Model& model, const SuggestOptions& options);

}  // namespace awmr
