/// Reads and writes model.json (`awmr.model/1`).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr {

/// Errors: as read_json_file; unknown or missing keys; values that are out of range (ranges.h) or
/// contradict each other.
Result<Model> read_model(const std::filesystem::path& path);

/// As read_model(), from text; `file` names it in errors.
Result<Model> model_from_text(std::string_view text, const std::string& file);
/// Checks a text of model.json after writing by reading it back (core/file.h).
Status check_model_text(std::string_view text, const std::string& file);

/// Text of model.json.
std::string model_text(const Model& model);

/// Errors: as write_file.
Status write_model(const Model& model, const std::filesystem::path& path);

/// The JSON Schema of model.json, derived from its reader.
std::string model_schema();

}  // namespace awmr
