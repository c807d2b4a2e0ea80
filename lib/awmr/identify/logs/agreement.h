/// Comparison of a parameter from logs with its value from other trials. Private to identify/.
#pragma once

#include <optional>
#include <string>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/model/model.h"

namespace awmr {

/// Returns the warning `estimates-disagree` if parameter `i` of the log fit differs significantly
/// from `known`, its estimate from other trials. The test is a two-sided normal test (p < 0.01) of
/// the fitted coordinates, which are logarithms for most parameters. Empty if the estimates agree
/// or `known` has no standard error.
std::optional<Finding> disagreement(const LogFit& fit, std::size_t i, const Estimate& known,
                                    const std::string& file);

}  // namespace awmr
