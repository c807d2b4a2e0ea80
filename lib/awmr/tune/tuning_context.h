/// Makes the context of the constraints (constraints.h) for one tuning, and fills in the limits
/// whose defaults depend on it. Private to tune/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/control/disturbance_observer.h"
#include "awmr/core/result.h"
#include "awmr/model/vehicle.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Returns the context for ideal sensors and motors. Its speed, heading step and yaw rate are the
/// largest of all scenarios.
ConstraintContext context_of(const TuneOptions& options, const Plant<double>& plant,
                             const Vehicle& vehicle, const std::vector<Scenario>& scenarios);

/// As default_tuning_scenario(), but without adding the decay of the heading error to the duration,
/// which takes long to compute. For context_of(), which does not use the duration. Errors (input):
/// those of Model::plant().
Result<Scenario> examined_scenario(const Model& model);

void add_conditions(const LoopConditions& conditions, ConstraintContext& context);

/// Sets the limit of the steering rate to its default, if it is absent (TuningLimits).
void limit_steering_rate(ConstraintContext& context);

/// Default limits of an observer (ObserverSearch), in surge and in yaw. At most 0 if the wheels
/// have no force left at the speed of the context.
AxisForces<double> observer_limits(const ConstraintContext& context);

/// Sets the limits of an observer that are absent to observer_limits(). Errors (input): at the
/// speed of the scenarios, the wheels have no force left to compensate a disturbance.
Status limit_observer(const ConstraintContext& context, std::optional<ObserverSearch>& observer);

}  // namespace awmr
