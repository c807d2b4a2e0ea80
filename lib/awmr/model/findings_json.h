/// Converts findings to and from JSON, as in `/findings` of model.json. Not installed; include from
/// .cpp files only.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/json/json.h"
#include "awmr/model/record.h"

namespace awmr {

Json findings_to_json(const std::vector<Finding>& findings);

/// Adds the key `findings` and its members to the JSON Schema of an object.
void describe_findings(JsonObject& json);

/// Reads the key `findings` of a document; empty if there is none.
std::vector<Finding> read_findings(JsonObject& json);

/// The document with `findings` as its last key; existing findings are replaced. File names in
/// findings have no directories, so that the bytes do not depend on where the files are.
/// Precondition: `document` is a JSON object.
std::string with_findings(const std::string& document, const std::vector<Finding>& findings);

}  // namespace awmr
