/// Text for a terminal: line wrapping, and the headline of a claim. Private to validate/.
#pragma once

#include <cstddef>
#include <string>

#include "awmr/validate/validate.h"

namespace awmr {

/// Wraps text to lines of 100 characters, all indented by `indent` spaces.
std::string wrapped(const std::string& text, std::size_t indent);

/// Number, verdict and statement of a claim, wrapped.
std::string claim_headline(const Claim& claim);

}  // namespace awmr
