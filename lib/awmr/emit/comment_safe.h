/// Makes names that come from files safe inside comments of emitted files. Private to emit/.
#pragma once

#include <string>
#include <string_view>

namespace awmr {

/// Returns the text as one line of printable ASCII, with '?' for other characters. The result does
/// not end or start a C comment, and does not continue a line comment of any language.
std::string comment_safe(std::string_view text);

}  // namespace awmr
