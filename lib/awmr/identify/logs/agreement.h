/// Comparison of a parameter from logs with its value from other trials. Private to identify/.
#pragma once

#include <optional>
#include <string>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/model/model.h"

namespace awmr {

/// The warning `estimates-disagree` if parameter `i` of the log fit differs significantly from its
/// estimate `known` by other trials (two-sided normal test of the fitted coordinate, for most
/// parameters the logarithm; p < 0.01). Else empty, also if `known` has no standard error.
std::optional<Finding> disagreement(const LogFit& fit, std::size_t i, const Estimate& known,
                                    const std::string& file);

}  // namespace awmr
