/// Findings formatted for a terminal.
#pragma once

#include <string>
#include <vector>

#include "awmr/model/record.h"
#include "style.h"

namespace awmr::cli {

/// Formats a finding as `warning: FILE:LINE: MESSAGE [CODE]`, like a compiler.
std::string to_text(const Finding& finding, const Style& style);

/// If there are few findings, one line each, largest effect first. Otherwise every error and the
/// first of the others, at least three, then the count of each further code.
std::string findings_text(const std::vector<Finding>& findings, const Style& style);

}  // namespace awmr::cli
