/// How this machine rounds.
#pragma once

#include <string>

namespace awmr {

/// What the mathematical functions of the C library come to here, to their last bits, as 16
/// hexadecimal digits. The library chooses its functions by the processor, and with fused
/// multiply-add some results are another neighbour of the true one: only on machines that agree in
/// this are the bytes of a result the same.
std::string rounding_of_functions();

}  // namespace awmr
