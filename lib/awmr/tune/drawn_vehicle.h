/// A vehicle on which gains are tuned or evaluated. Private to tune/.
#pragma once

#include "awmr/core/interval.h"
#include "awmr/model/dynamics.h"

namespace awmr {

struct DrawnVehicle {
  Plant<double> plant{};
  Interval wheel_force{-1.0, 1.0};  ///< range of a wheel's force divided by F_max; the allocation
                                    ///< clips to it
};

}  // namespace awmr
