/// Line wrapping of text for a terminal. Private to validate/.
#pragma once

#include <cstddef>
#include <string>

namespace awmr {

/// Wraps text to lines of 100 characters, all indented by `indent` spaces.
std::string wrapped(const std::string& text, std::size_t indent);

}  // namespace awmr
