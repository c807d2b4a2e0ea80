/// What forces beyond a vehicle's limit most likely are. Private to this folder.
#pragma once

#include <string>

namespace awmr {

struct FullScale {
  std::string words;    ///< "the forces look like percent"
  double factor = 1.0;  ///< that makes them F'
};

/// By the largest force found; `limit` is the vehicle's largest F'.
FullScale full_scale_of(double largest, double limit);

}  // namespace awmr
