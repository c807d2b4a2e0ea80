/// Checks of the input of compare(), before anything is simulated. Private to compare/.
#pragma once

#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/result.h"

namespace awmr {

/// Checks the input of compare(). Errors (input): an option is out of range; no scenario or gains;
/// two scenarios or two sets of gains with the same name; break-even combined with options that
/// exclude it; more than kMaxRuns runs; the errors of controller_for().
Status check_comparison(const Model& model, const std::vector<NamedGains>& gains,
                        const std::vector<Scenario>& scenarios, const CompareOptions& options);

}  // namespace awmr
