/// Calibration of a compass (magnetometer) in a vehicle on level ground. It has two horizontal
/// axes: one ahead and one to the left.
#pragma once

#include "awmr/core/interval.h"

namespace awmr {

/// A number with its 95 % interval.
struct WithInterval {
  double value = 0.0;
  Interval ci95 = {};
};

/// While the vehicle turns, the measured field f (ahead and left, in any unit) describes an
/// ellipse. Magnets on the vehicle shift its centre o (hard iron), and iron deforms it (soft iron).
/// The calibrated field c describes a circle:
///     c = S (f - o),  S symmetric, det S = 1,  |c| = field
///     heading = atan2(-c_left, c_ahead) - declination, counter-clockwise from true north
struct CompassCalibration {
  WithInterval centre_ahead;  ///< o ahead, in the unit of f
  WithInterval centre_left;   ///< o to the left
  WithInterval gain_ahead;    ///< S: gain from ahead to ahead
  WithInterval gain_cross;    ///< S: gain from left to ahead, and from ahead to left
  WithInterval gain_left;     ///< S: gain from left to left
  WithInterval field;         ///< radius of the circle that c describes, in the unit of f, > 0
  double residual = 0.0;      ///< standard deviation of |c|, divided by `field`
  /// 97.5 % bound of the error of a calibrated heading, in the direction in which this bound is
  /// largest
  double heading_error_deg = 0;
  double turned_deg = 0.0;       ///< angle turned from the first row to the last, left positive
  double largest_gap_deg = 0.0;  ///< largest angle between neighbouring measured field directions
  double declination_deg = 0.0;  ///< from true north to magnetic north, east positive
};

}  // namespace awmr
