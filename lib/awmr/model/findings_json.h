/// Converts findings to and from JSON, as in `/findings` of model.json. Not installed; include from
/// .cpp files only.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/json.h"
#include "awmr/model/record.h"

namespace awmr {

Json findings_to_json(const std::vector<Finding>& findings);

/// Adds the key `findings` and its members to the JSON Schema of an object.
void describe_findings(JsonObject& json);

/// Reads the key `findings` of a document; empty if there is none.
std::vector<Finding> read_findings(JsonObject& json);

/// The document with `findings` as its last key, replacing existing ones. Files are given by name,
/// without directories, so that the bytes do not depend on their location. Precondition: `document`
/// is a JSON object.
std::string with_findings(const std::string& document, const std::vector<Finding>& findings);

}  // namespace awmr
