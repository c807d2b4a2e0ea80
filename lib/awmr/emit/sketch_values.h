/// Speed of routes and limits of the heading error, for the sketches. Private to emit/.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/vehicle.h"

namespace awmr {

struct SketchValues {
  double route_mps = 0.0;  ///< AWMR_ROUTE_SPEED_MPS, m/s
  /// Heading error, rad, if the forces of the motors differ by 16 %.
  double steady_error_rad = 0.0;
  double on_course_rad = 0.0;    ///< AWMR_ON_COURSE_RAD, rad
  double off_course_mrad = 0.0;  ///< AWMR_OFF_COURSE_MRAD, m rad
};

/// Computes values that suit every mode, the largest that a mode needs with its gains.
/// `full_force`: sum of the largest F' of the four wheels, beyond the dead zone.
SketchValues sketch_values(const Plant<double>& plant, const Vehicle& vehicle,
                           const ModeGains& gains, double full_force);

}  // namespace awmr
