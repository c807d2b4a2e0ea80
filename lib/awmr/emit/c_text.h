/// Numbers and comments in the text of emitted files. Private to emit/.
#pragma once

#include <string>
#include <string_view>

namespace awmr {

/// Returns the float nearest to `value` as a C literal, with nine significant digits (%.9g) and the
/// suffix `f`. A compiler reads the literal as the same float.
std::string float_literal(double value);

/// Returns the text as one line of printable ASCII, with '?' for each other character. The line
/// contains no start or end of a C comment, and no line break that would end a line comment.
std::string comment_safe(std::string_view text);

}  // namespace awmr
