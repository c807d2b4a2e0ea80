/// Sensitivity of the tuned loop to its assumptions. Private to this folder.
#pragma once

#include "awmr/core/result.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Computes the Sobol indices of the loop's metrics (settling, overshoot, error), by mode. Inputs:
///   - each group of correlated parameters, drawn from the model's covariance;
///   - the level of the sensor noise, the latency and the motor lag, each uniform from 0 to twice
///     the assumed value;
///   - the noise realisation.
/// `setting`: with the model's own plant and noise-free scenarios. With several scenarios, a metric
/// is the mean over them.
/// Errors (input): as PlantSampler's; (refused): a run breaks off.
Result<GlobalSensitivity> global_sensitivity(const Model& model, const ObjectiveSetting& setting,
                                             const LoopConditions& assumed,
                                             const Gains<double>& gains, int samples);

/// Number of runs for `samples` samples of a model in one mode and scenario.
double sensitivity_runs(const Model& model, int samples);

}  // namespace awmr
