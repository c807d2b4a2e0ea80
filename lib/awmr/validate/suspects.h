/// What single change would bring a drive and its model together. Private to this folder.
#pragma once

#include <vector>

#include "awmr/control/controller.h"
#include "awmr/validate/acceptance.h"
#include "awmr/validate/drive_series.h"

namespace awmr {

/// Mean and standard deviation of what is foretold of a channel, by window.
struct ForetoldSeries {
  std::vector<double> mean;
  std::vector<double> spread;
};

/// A channel of the drive, as it was measured and as it was foretold.
struct SuspectChannel {
  const DriveChannel* channel;
  const WindowMeans* measured;
  const ForetoldSeries* foretold;
};

/// Each parameter, the motors, the sensors' biases and lateness, constant pushes: the value of each
/// that, alone, makes the run least distant from the drive. Those that explain 30 % and more, the
/// best first, at most four. The chip's controller stays as it is: only the vehicle changes.
std::vector<Suspect> suspects_of(const Model& model, const Controller<double>& controller,
                                 const Scenario& scenario, const AcceptanceOptions& options,
                                 double duration_s, const std::vector<SuspectChannel>& evidence);

}  // namespace awmr
