/// Formats numbers as C source. Private to emit/.
#pragma once

#include <string>

namespace awmr {

/// The float nearest to `value`, as %.9g and `f`: it reads back to the same float.
std::string float_literal(double value);

}  // namespace awmr
