/// Comparison of a parameter from logs with that from other trials. Private to identify/.
#pragma once

#include <optional>
#include <string>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/model/model.h"

namespace awmr {

/// `estimates-disagree` if the fit's i-th quantity, a parameter, differs significantly from the
/// estimate of other trials (normal in the coordinate, two-sided, p < 0.01). Empty if the other
/// trials gave no value with a standard error.
std::optional<Finding> disagreement(const LogFit& fit, std::size_t i, const Estimate& known,
                                    const std::string& file);

}  // namespace awmr
