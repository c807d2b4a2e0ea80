// Embedded source files of the firmware.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace awmr::pil {

/// Name and content of each file.
const std::vector<std::pair<std::string_view, std::string_view>>& firmware_sources();

}  // namespace awmr::pil
