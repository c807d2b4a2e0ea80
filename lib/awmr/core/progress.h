/// How far work that takes long has come.
#pragma once

#include <cstddef>
#include <functional>

namespace awmr {

/// Is told how many parts of all are done: their number may fall short of `total`, where the work
/// ends early. Calls do not overlap. Empty: nobody asks. It has no part in the result.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace awmr
