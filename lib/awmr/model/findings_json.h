/// Findings as the JSON under model.json's /findings. Not installed; include from .cpp files only.
#pragma once

#include <vector>

#include "awmr/core/json.h"
#include "awmr/model/record.h"

namespace awmr {

Json findings_to_json(const std::vector<Finding>& findings);

/// What `findings` of an object holds, for a schema.
void describe_findings(JsonObject& json);

}  // namespace awmr
