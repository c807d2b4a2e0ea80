/// Finds single changes of the model that explain a drive. Private to this folder.
#pragma once

#include <vector>

#include "awmr/control/controller.h"
#include "awmr/validate/acceptance.h"
#include "awmr/validate/drive_series.h"

namespace awmr {

/// Mean and standard deviation of the predictions of a channel, by window.
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

/// Fault hypotheses: each parameter, the motors, the sensors' biases and latencies, constant
/// external forces. For each, finds the value that alone minimises the distance of the run from the
/// drive. Returns those that explain at least 30 %, the best first, at most four. Only the vehicle
/// changes; the controller stays the same.
std::vector<FaultHypothesis> fault_hypotheses(const Model& model,
                                              const Controller<double>& controller,
                                              const Scenario& scenario,
                                              const AcceptanceOptions& options, double duration_s,
                                              const std::vector<EvidenceChannel>& evidence);

}  // namespace awmr
