/// Checks of the input of compare(), before anything is simulated. Private to compare/.
#pragma once

#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/result.h"

namespace awmr {

/// Errors (input): an option is out of range; no scenario or gains; two with the same name; break
/// even with options that it does not support; more than kMaxRuns runs; as controller_for().
Status check_comparison(const Model& model, const std::vector<NamedGains>& gains,
                        const std::vector<Scenario>& scenarios, const CompareOptions& options);

}  // namespace awmr
