/// A parameter by the logs and by other trials. Private to identify/.
#pragma once

#include <optional>
#include <string>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/model/model.h"

namespace awmr {

/// `estimates-disagree` where the fit's i-th quantity, a parameter, and the estimate of other
/// trials differ by more than their errors allow (normal in the coordinate, two-sided, p < 0.01).
/// Empty if the other trials gave no value with an error.
std::optional<Finding> disagreement(const LogFit& fit, std::size_t i, const Estimate& known,
                                    const std::string& file);

}  // namespace awmr
