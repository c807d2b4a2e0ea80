/// Changes of the limits and bounds in tune.json with which gains meet the constraints. Private to
/// tune/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Advice for a constraint that no gains meet: the limit to relax, or the cause in the vehicle.
std::string advice_on(const std::string& constraint);

/// Changes of one limit or one requested bound, each of which alone permits gains that meet the
/// constraints that need no simulation: "`limits/late_damping` 0.55". Each is confirmed by a search
/// with the change. `nearest`: gains from which the searches start. `poles`: the default bounds are
/// around these.
std::vector<std::string> single_changes(const Gains<double>& nearest,
                                        const ConstraintContext& context,
                                        const TuneOptions& requested,
                                        std::span<const Gains<double>> poles);

}  // namespace awmr
