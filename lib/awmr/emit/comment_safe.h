/// Names from files inside comments of other languages. Private to emit/.
#pragma once

#include <string>
#include <string_view>

namespace awmr {

/// One line of printable ASCII, other characters as '?', that neither ends a C89 comment nor seems to
/// start one. Nothing in it ends a comment that goes to the end of its line, in any language.
std::string comment_safe(std::string_view text);

}  // namespace awmr
