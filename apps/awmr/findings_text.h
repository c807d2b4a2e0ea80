/// Findings formatted for a terminal.
#pragma once

#include <string>
#include <vector>

#include "awmr/model/record.h"
#include "style.h"

namespace awmr::cli {

/// Formats a finding as `warning: FILE:LINE: MESSAGE [CODE]`, like a compiler.
std::string to_text(const Finding& finding, const Style& style);

/// Text of the findings, those with the largest effect first. Few findings have a line each. Of
/// many, only the errors (at least three findings) have a line; a last line has the numbers of the
/// others by code.
std::string findings_text(const std::vector<Finding>& findings, const Style& style);

}  // namespace awmr::cli
