/// Findings as a person reads them on a terminal.
#pragma once

#include <string>
#include <vector>

#include "awmr/model/record.h"
#include "style.h"

namespace awmr::cli {

/// `warning: FILE:LINE: MESSAGE [CODE]`, as compilers do.
std::string to_text(const Finding& finding, const Style& style);

/// A line each, where there are few, those that change the numbers most first. Else every error and the
/// first of the others, three in all at least, then how many there are of each further code.
std::string findings_text(const std::vector<Finding>& findings, const Style& style);

}  // namespace awmr::cli
