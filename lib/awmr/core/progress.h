/// Callback that reports the progress of long work.
#pragma once

#include <cstddef>
#include <functional>

namespace awmr {

/// Called with `done`, the number of finished steps, and `total`, the number of all steps. If the
/// work ends early, `done` never reaches `total`. Calls do not overlap. Leave the function empty if
/// no progress is needed.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace awmr
