/// Progress of long work.
#pragma once

#include <cstddef>
#include <functional>

namespace awmr {

/// Called with the number of finished parts, which can stay below `total` if the work ends early.
/// Calls do not overlap. Empty: no reports. It does not affect the result.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace awmr
