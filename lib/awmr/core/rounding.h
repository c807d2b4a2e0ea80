/// Detects machines whose mathematical functions round differently.
#pragma once

#include <string>

namespace awmr {

/// Hash (16 hexadecimal digits) of results of exp, log, pow and other functions on this machine, to
/// their last bits. The C library has variants for different processors, some of which round
/// differently. Two machines give byte-identical results only if their hashes are equal.
std::string rounding_of_functions();

}  // namespace awmr
