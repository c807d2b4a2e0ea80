/// SHA-256, by which every output names its inputs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "awmr/core/result.h"

namespace awmr {

/// 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);
Result<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace awmr
