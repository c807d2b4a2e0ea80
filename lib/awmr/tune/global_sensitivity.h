/// Sensitivity of the tuned loop to its assumptions. Private to this folder.
#pragma once

#include "awmr/core/result.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Sobol's indices of how the loop with these gains settles, overshoots and errs, by mode. The inputs: each set of
/// parameters that the model's covariance ties to each other, drawn from it; the level of the sensors' noise, how late
/// they are and the motors' lag, each even from none to twice what is assumed; and the noise itself. `setting`: with
/// the model's own plant and the scenarios as they are without noise. Over several scenarios a figure is the mean.
/// Errors (input): as PlantSampler's; (refused): a run breaks off.
Result<GlobalSensitivity> global_sensitivity(const Model& model, const ObjectiveSetting& setting,
                                             const LoopConditions& assumed,
                                             const Gains<double>& gains, int samples);

/// Runs that `samples` of a model take in one mode and scenario.
double sensitivity_runs(const Model& model, int samples);

}  // namespace awmr
