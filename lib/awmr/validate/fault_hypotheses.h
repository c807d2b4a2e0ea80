/// Search for single faults (changes of the vehicle, its sensors or forces) that explain a drive.
/// Private to validate/.
#pragma once

#include <vector>

#include "awmr/control/controller.h"
#include "awmr/validate/acceptance.h"
#include "awmr/validate/drive_series.h"

namespace awmr {

/// Mean and standard deviation of a channel over the predicted drives, by window.
struct PredictedBand {
  std::vector<double> mean;
  std::vector<double> spread;
};

/// A channel of the drive, measured and predicted.
struct EvidenceChannel {
  const DriveChannel* channel;
  const WindowMeans* measured;
  const PredictedBand* predicted;
};

/// Tries each fault hypothesis: each parameter, the motors, the biases and latencies of the sensors,
/// constant external forces. For each, the value is searched that minimises the squared distance of
/// the simulated run from the drive. Returns the hypotheses that remove at least 30 % of it, best
/// first, at most four. The controller stays the same.
std::vector<FaultHypothesis> fault_hypotheses(const Model& model,
                                              const Controller<double>& controller,
                                              const Scenario& scenario,
                                              const AcceptanceOptions& options, double duration_s,
                                              const std::vector<EvidenceChannel>& evidence);

}  // namespace awmr
