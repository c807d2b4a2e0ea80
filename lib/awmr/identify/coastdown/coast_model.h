/// Decides whether the recorded speed of coast-down curves is low-pass filtered, and whether the
/// model describes the curves. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/coastdown/coast_problem.h"
#include "awmr/identify/coastdown/readings.h"
#include "awmr/identify/logs/problem/channel_noise.h"

namespace awmr {

/// Model of the curves, chosen by choose_coast_model().
struct CoastModel {
  CoastStart start;  ///< m' and, if there is a filter, its time constant
  /// Another solution that describes the curves nearly as well; absent if there is none. Example:
  /// if the resistance is proportional to the speed, the time constants of the filter and of the
  /// deceleration (m'/a1) can be exchanged without a change of the curve.
  std::optional<CoastStart> other;
  /// Noise of the residuals. In the fit that gives it, the surge law may vary within its
  /// covariance.
  ChannelNoise noise;

  bool withdraws_intervals() const { return other || noise.overwhelms_sensor(); }
};

/// Fits the curves without and with a low-pass filter in the speed sensor. Keeps the filter if its
/// time constant is above 2 standard errors and the filter lowers AICc by more than 4 (10 if the
/// filter is slower than the motion). With these limits, about 2 of 100 simulated trials without a
/// filter get one. In both fits, the noise may have a drift, and the surge law may deviate from
/// `surge` within its covariance. Without this freedom, the fit would explain a disturbance, or an
/// error of the surge law, by a filter.
CoastModel choose_coast_model(const CoastReadings& readings, const SteadyFit& surge);

/// A surge law with the AICc of its fit to the surge runs.
struct ScoredLaw {
  const SteadyFit& fit;
  double aicc = 0.0;
};

/// The law that surge runs and curves together describe best.
struct LawOfCurves {
  std::size_t index = 0;  ///< index in the list of laws
  double decrease = 0.0;  ///< AICc of the first law minus that of this law
};

/// Compares the laws on surge runs and curves together. The score of a law is its AICc for the
/// surge runs plus -2 ln L of the curves, in a fit in which the law may vary within its covariance
/// and the speed may be filtered. All laws are compared under one noise model of the curves, that
/// of the smallest residuals, because the drift of a law's own noise model absorbs the law's error.
/// Returns the law with the lowest score if the score is lower than that of the first law by more
/// than kFamilyAicThreshold and the law describes the curves (ChannelNoise::of_the_model() is
/// false). Empty otherwise, and if the first law describes the curves.
std::optional<LawOfCurves> law_of_curves(const CoastReadings& readings,
                                         const std::vector<ScoredLaw>& laws);

/// The finding `model-inadequate`, if the model does not describe the curves
/// (ChannelNoise::of_the_model()).
std::vector<Finding> inadequacy(const CoastModel& model, const std::string& file);

}  // namespace awmr
