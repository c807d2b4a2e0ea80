/// model.json (`awmr.model/1`).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace awmr {

/// Errors: as read_json_file; unknown, missing or impossible values.
Result<Model> read_model(const std::filesystem::path& path);

/// The bytes of model.json.
std::string model_text(const Model& model);

/// The findings as they are under model.json's /findings.
std::string findings_text(const std::vector<Finding>& findings);

/// Errors: as write_file.
Status write_model(const Model& model, const std::filesystem::path& path);

}  // namespace awmr
