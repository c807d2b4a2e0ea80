/// A vehicle on which gains are tuned or evaluated. Private to tune/.
#pragma once

#include "awmr/core/interval.h"
#include "awmr/model/dynamics.h"

namespace awmr {

struct DrawnVehicle {
  Plant<double> plant{};
  /// Range of the force of one wheel, divided by F_max. The allocation clips the wheel forces to
  /// it.
  Interval wheel_force{-1.0, 1.0};
};

}  // namespace awmr
