/// Makes names that come from files safe for use in comments of emitted files. Private to emit/.
#pragma once

#include <string>
#include <string_view>

namespace awmr {

/// Returns the text as one line of printable ASCII, with '?' for each other character. The line
/// contains no start or end of a C comment, and no line break that would end a line comment.
std::string comment_safe(std::string_view text);

}  // namespace awmr
