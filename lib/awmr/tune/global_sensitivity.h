/// Sobol indices of the tuned loop's metrics. They show which uncertain input (plant parameters,
/// sensor noise, latency, motor lag) affects each metric most. Private to tune/.
#pragma once

#include "awmr/core/result.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Computes the Sobol indices of settling time, overshoot and heading error, by mode. Inputs:
///   - each group of correlated parameters, drawn from the model's covariance;
///   - the size of the sensor noise, the latency and the motor lag, each uniform from 0 to twice
///     the assumed value;
///   - the noise realisation.
/// Precondition: `setting` has the identified plant and noise-free scenarios. With several
/// scenarios, a metric is the mean over them. Errors (input): as PlantSampler's; (refused): a run
/// breaks off.
Result<GlobalSensitivity> global_sensitivity(const Model& model, const ObjectiveSetting& setting,
                                             const LoopConditions& assumed,
                                             const Gains<double>& gains, int samples);

/// Number of runs that global_sensitivity() needs per mode and scenario.
double sensitivity_runs(const Model& model, int samples);

}  // namespace awmr
