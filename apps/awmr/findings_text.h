/// Findings formatted for a terminal.
#pragma once

#include <string>
#include <vector>

#include "awmr/model/record.h"
#include "style.h"

namespace awmr::cli {

/// Formats a finding as `warning: FILE:LINE: MESSAGE [CODE]`, like a compiler.
std::string to_text(const Finding& finding, const Style& style);

/// Formats the findings, those with the largest effect on the results first. The first three
/// findings and all errors have a line each. If two or more other findings remain, a last line
/// counts them by code.
std::string findings_text(const std::vector<Finding>& findings, const Style& style);

}  // namespace awmr::cli
