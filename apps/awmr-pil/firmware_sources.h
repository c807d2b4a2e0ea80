// The firmware's own files, as they were built in.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace awmr::pil {

/// Name and bytes.
const std::vector<std::pair<std::string_view, std::string_view>>& firmware_sources();

}  // namespace awmr::pil
