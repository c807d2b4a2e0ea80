/// project.json (`awmr.project/1`): one file from which `awmr run` does everything.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/result.h"
#include "awmr/identify/identify.h"
#include "awmr/trials/read_trials.h"
#include "heading_rate_option.h"

namespace awmr::cli {

/// Paths are given relative to the project file and kept resolved.
struct Project {
  std::filesystem::path vehicle;
  std::optional<std::filesystem::path> surge;
  std::vector<std::filesystem::path> coastdowns;
  std::optional<std::filesystem::path> turning;
  std::vector<std::filesystem::path> logs;
  bool steady_from_logs = false;
  TrialOptions trials;
  IdentifyOptions identify;
  std::optional<std::filesystem::path> tune;  ///< tune.json
  std::vector<std::filesystem::path> scenarios;
  CompareOptions compare;
  HeadingRateChoice heading_rate_limit = {};  ///< of the comparison
};

/// Errors: as read_json_file; unknown or missing keys, a malformed column mapping.
Result<Project> read_project(const std::filesystem::path& path);

/// The JSON Schema of project.json, from what reads it.
std::string project_schema();

}  // namespace awmr::cli
