/// Makes names from files safe inside comments of other languages. Private to emit/.
#pragma once

#include <string>
#include <string_view>

namespace awmr {

/// Returns one line of printable ASCII, with other characters as '?', that neither ends nor appears
/// to start a C89 comment. It also cannot end a comment that extends to the end of its line, in any
/// language.
std::string comment_safe(std::string_view text);

}  // namespace awmr
