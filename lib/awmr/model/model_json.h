/// Converts the lists of model.json to JSON and back. Private to this folder.
#pragma once

#include "awmr/core/json/json.h"
#include "awmr/model/model.h"

namespace awmr {

/// Returns null for an absent value, and for infinity and NaN, which JSON does not have.
Json number_or_null(const std::optional<double>& value);
Json interval_or_null(const std::optional<Interval>& interval);

/// Adds to each fault about a missing estimate (in `file`, a model.json) which quantity it is, and
/// where its value comes from.
void explain_missing_estimates(const std::string& file, const Vehicle& vehicle,
                               std::vector<Fault>& faults);

Json report_to_json(const EstimatorReport& report);
EstimatorReport report_from_json(JsonObject& json);

Json covariance_to_json(const Covariance& covariance);
/// Reads the covariance of the parameters. Faults: unknown or repeated parameters; a matrix that
/// has the wrong size, is not symmetric, has a negative variance, or correlations that contradict
/// each other.
Covariance covariance_from_json(JsonObject& json);

Finding finding_from_json(JsonObject& json);

Json trial_to_json(const TrialPoint& trial);
TrialPoint trial_from_json(JsonObject& json);

}  // namespace awmr
