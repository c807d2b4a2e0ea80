/// Searches for the cause of a drive that differs from the prediction: a single change of the
/// vehicle, its sensors, or the forces on it. Private to validate/.
#pragma once

#include <vector>

#include "awmr/control/controller.h"
#include "awmr/validate/acceptance.h"
#include "awmr/validate/drive_series.h"

namespace awmr {

/// Mean and standard deviation of a channel over the predicted drives, by window.
struct PredictedBand {
  std::vector<double> mean;
  std::vector<double> spread;  ///< standard deviation, with a small lower bound > 0
};

/// A channel of the logged drive, its prediction, and the distances of the predicted drives.
struct ComparedChannel {
  DriveChannel channel;
  WindowMeans measured;
  PredictedBand predicted;
  std::vector<double> largest;  ///< for each predicted drive, its largest distance in this channel
  double usual = 0.0;           ///< 95 % quantile of `largest` over the predicted drives
};

/// Tries each fault hypothesis. It changes a parameter (except exponents), the force or lag of the
/// motors, or the bias or latency of a sensor, or adds a constant external force or moment. For
/// each hypothesis, searches the value that minimises the sum of squared distances between the
/// simulated run and the drive. The controller stays the same. Returns the hypotheses that remove
/// at least 30 % of this sum, best first, at most four.
std::vector<FaultHypothesis> fault_hypotheses(const Model& model,
                                              const Controller<double>& controller,
                                              const Scenario& scenario,
                                              const AcceptanceOptions& options, double duration_s,
                                              const std::vector<ComparedChannel>& channels);

}  // namespace awmr
