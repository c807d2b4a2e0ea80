/// Calibration of a compass that is level in the vehicle.
#pragma once

#include "awmr/core/interval.h"

namespace awmr {

/// A number with its 95 % interval.
struct WithInterval {
  double value = 0.0;
  Interval ci95 = {};
};

/// While the vehicle turns, the field f in its plane (ahead and left, in any unit) describes an
/// ellipse. Magnets that turn with the vehicle shift its centre (hard iron); iron deforms it (soft
/// iron).
///     c = S (f - o),  S symmetric, det S = 1,  |c| = field
///     heading = atan2(-c_left, c_ahead) - declination, counter-clockwise from true north
struct CompassCalibration {
  WithInterval centre_ahead;  ///< o, in the unit of f
  WithInterval centre_left;
  WithInterval gain_ahead;  ///< S
  WithInterval gain_cross;
  WithInterval gain_left;
  WithInterval field;            ///< strength in the plane, in the unit of f, > 0
  double residual = 0.0;         ///< standard deviation of |c| over `field`
  double heading_error_deg = 0;  ///< 97.5 % bound of the fit's heading uncertainty, worst direction
  double turned_deg = 0.0;       ///< from the first row to the last, left positive
  double largest_gap_deg = 0.0;  ///< between two adjacent directions
  double declination_deg = 0.0;  ///< from true north to magnetic north, east positive
};

}  // namespace awmr
