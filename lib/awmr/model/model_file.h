/// Reads and writes model.json (`awmr.model/1`).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr {

/// Reads model.json. Errors: those of read_json_file(); unknown or missing keys; values out of
/// range (ranges.h); values that contradict each other, such as a value outside its interval; an
/// implausible vehicle (plausibility.h) that the user did not accept with `identify --as-is`.
Result<Model> read_model(const std::filesystem::path& path);
/// As read_model(), but accepts a vehicle whose values are implausible (plausibility.h), as long as
/// they are within the ranges of ranges.h.
Result<Model> read_model_as_is(const std::filesystem::path& path);

/// As read_model(), but reads a text in memory. `file`: name of the text in errors.
Result<Model> model_from_text(std::string_view text, const std::string& file);
/// Checks that a text of model.json can be read, before it is written (ReadBack in core/file.h).
/// Errors: those of model_from_text().
Status check_model_text(std::string_view text, const std::string& file);

/// Text of model.json.
std::string model_text(const Model& model);

/// Writes model.json. Errors: those of write_file().
Status write_model(const Model& model, const std::filesystem::path& path);

/// The JSON Schema of model.json, derived from its reader.
std::string model_schema();

}  // namespace awmr
