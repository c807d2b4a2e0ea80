/// Changes of the limits and bounds in tune.json with which gains meet the constraints. Private to
/// tune/.
#pragma once

#include <string>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Advice for a constraint that no gains meet: the limit to relax, or the cause in the vehicle.
std::string advice_on(const std::string& constraint);

/// Pointer in tune.json to the limit of a constraint; "/bounds" if it has none.
std::string pointer_to(const std::string& constraint);

/// Limits of tune.json that the user made stricter than their defaults: "`margin`".
std::vector<std::string> stricter_than_default(const TuneOptions& requested);

/// Changes of one limit or one requested bound, each of which alone permits gains that meet the
/// constraints that need no simulation: "`limits/late_damping` 0.55". Each is confirmed by the
/// search for a start that tune() makes with the change. `nearest`: gains with the smallest
/// violation, from which the searches start too.
std::vector<std::string> single_changes(const Gains<double>& nearest,
                                        const ConstraintContext& context,
                                        const TuneOptions& requested);

}  // namespace awmr
