/// Numbers and comments in the text of emitted files. Private to emit/.
#pragma once

#include <string>
#include <string_view>

namespace awmr {

/// Returns the float nearest to `value` as a C literal, with nine significant digits (%.9g) and the
/// suffix `f`. A compiler reads it back as the same float.
std::string float_literal(double value);

/// Returns the text as one line of printable ASCII, safe inside a C comment: each other character
/// becomes '?', and the text cannot begin or end a comment.
std::string comment_safe(std::string_view text);

}  // namespace awmr
