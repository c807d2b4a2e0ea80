/// Decides whether the speed of coast-down curves has passed a low-pass filter, and whether the
/// model describes the curves. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/coastdown/coast_problem.h"
#include "awmr/identify/coastdown/readings.h"
#include "awmr/identify/logs/channel_noise.h"

namespace awmr {

/// Model of the curves, chosen by choose_coast_model().
struct CoastModel {
  CoastStart start;  ///< m' and, if there is a filter, its time constant
  /// Another m' and time constant that describe the curves nearly as well. (With a resistance in
  /// proportion to the speed, a filter and m'/a1 can be exchanged.)
  std::optional<CoastStart> other;
  ChannelNoise noise;      ///< of the residuals, with a surge law within its uncertainty
  double longest_s = 0.5;  ///< drifts that last longer are model errors

  bool is_inadequate() const { return noise.of_the_model(longest_s); }
  bool withdraws_intervals() const { return other || noise.overwhelms_sensor(longest_s); }
};

/// Fits the curves without and with a filter of the speed. The filter is kept if it lowers AICc by
/// at least 4, or 10 if it is slower than the motion, and if its time constant is above 2 standard
/// errors. Of simulated trials without a filter, about 2 of 100 get one. For AICc, the noise may
/// have a drift, and the surge law may differ from `surge` at the cost of its likelihood, so that
/// neither a disturbance nor an error of the law counts as a filter.
CoastModel choose_coast_model(const CoastReadings& readings, const SteadyFit& surge);

/// The finding `model-inadequate`, if there is a model error.
std::vector<Finding> inadequacy(const CoastModel& model, const std::string& file);

}  // namespace awmr
