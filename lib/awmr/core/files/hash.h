/// SHA-256 hash, by which output files identify the input files that they were made from.
#pragma once

#include <string>
#include <string_view>

namespace awmr {

/// The hash of the bytes as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace awmr
