/// Fingerprint of this machine's floating-point rounding.
#pragma once

#include <string>

namespace awmr {

/// Hash of results of the C library's mathematical functions, to their last bits, as 16 hexadecimal
/// digits. The library selects variants by processor, and with fused multiply-add some results
/// round differently. Results are byte-identical only between machines with the same value.
std::string rounding_of_functions();

}  // namespace awmr
