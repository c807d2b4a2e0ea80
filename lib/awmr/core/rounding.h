/// Detects machines whose mathematical functions round differently.
#pragma once

#include <string>

namespace awmr {

/// Hash (16 hexadecimal digits) of all bits of results of exp, log, pow and other functions on this
/// machine. Two machines give byte-identical results only if their hashes are equal, because the C
/// library has variants of these functions for different processors that round differently.
std::string rounding_of_functions();

}  // namespace awmr
