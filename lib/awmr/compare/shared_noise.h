/// Sensor noise shared by the runs of a scenario in different modes and with different gains.
/// Private to compare/.
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <mutex>

#include "awmr/simulate/batch.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Noise of some samples of a scenario, used by several blocks of runs, possibly on different
/// threads. The first block that needs the noise draws it; the last one frees it.
class SharedNoise {
 public:
  /// Noise of each sample, by the number of the sample.
  using Drawn = std::map<std::size_t, DrawnNoise>;

  /// Registers a block that will use the noise. Must be called for all blocks before the first of
  /// them starts.
  void add_user() { ++users_; }

  /// Returns the noise. The first call obtains it from `draw()`.
  template <class Draw>
  const Drawn& drawn(const Draw& draw) {
    std::call_once(once_, [&] { drawn_ = draw(); });
    return drawn_;
  }

  /// Unregisters a block that no longer needs the noise. The last one frees the noise.
  void remove_user() {
    if (--users_ == 0) drawn_.clear();
  }

 private:
  std::once_flag once_;
  std::atomic<std::size_t> users_ = 0;
  Drawn drawn_;
};

}  // namespace awmr
