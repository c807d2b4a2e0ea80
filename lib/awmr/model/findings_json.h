/// Findings as the JSON under model.json's /findings. Not installed; include from .cpp files only.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/json.h"
#include "awmr/model/record.h"

namespace awmr {

Json findings_to_json(const std::vector<Finding>& findings);

/// What `findings` of an object holds, for a schema.
void describe_findings(JsonObject& json);

/// The findings of a document, each with its place in it; empty where it has none.
std::vector<Finding> read_findings(JsonObject& json);

/// The document with `findings` as its last key, in place of any that it has. Files are called by their
/// names, without folders: the same bytes wherever they lie. Precondition: `document` is a JSON object.
std::string with_findings(const std::string& document, const std::vector<Finding>& findings);

}  // namespace awmr
