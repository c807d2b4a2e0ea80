/// Callback that reports the progress of long work.
#pragma once

#include <cstddef>
#include <functional>

namespace awmr {

/// Called with the number of finished steps, `done`, and of all steps, `total`. If the work ends
/// early, `done` never reaches `total`. Calls do not overlap. Empty: no progress is reported.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace awmr
