/// Formats numbers as C source. Private to emit/.
#pragma once

#include <string>

namespace awmr {

/// Returns the float nearest to `value` as a C literal, with nine significant digits (%.9g) and the
/// suffix `f`. A compiler reads the literal as the same float.
std::string float_literal(double value);

}  // namespace awmr
