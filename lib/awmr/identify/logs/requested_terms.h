/// Terms of a log fit that the user requested by name (IdentifyOptions::terms). Private to
/// identify/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/identify/logs/quantities.h"

namespace awmr {

/// The terms with these names, with initial guesses. Names that are not requestable_terms() are
/// ignored.
std::vector<FreeTerm> requested_terms(std::span<const std::string> names);

}  // namespace awmr
