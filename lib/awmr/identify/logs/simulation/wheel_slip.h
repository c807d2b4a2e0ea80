/// Slip of wheels whose rotation measures the speed or the yaw rate, and the derivatives of the
/// readings with respect to the columns of the fit. Private to identify/.
///
/// A wheel that drives the vehicle rolls faster than it moves over ground. The wheels of a side
/// move over ground with w = u - d r (left) or u + d r (right), with half of the track width d. F'
/// is the wheel force after motor lag, dead zone and back-EMF. The slip s has two forms. With each
/// form, the wheels of a side roll at this speed:
///
///     w + s F'        s in m/s; no slip if w = 0
///     w + s F' |w|    s: slip ratio at F' = 1 (WheelSlip::is_ratio)
///
/// The measured speed is the mean of both sides, the measured yaw rate their difference (right -
/// left) over 2 d.
#pragma once

#include <vector>

#include "awmr/identify/logs/simulation/command_path.h"
#include "awmr/identify/logs/simulation/linear_stepper.h"

namespace awmr {

/// Slip s of the wheels that measure a channel, and the column of s among the unknowns of the fit.
struct WheelSlip {
  LogChannel channel;  ///< speed or yaw rate
  TermColumn slip;
  bool is_ratio;
};

/// The vehicle whose wheels slip, and the columns of the parameters and command errors in the fit.
struct SlippingWheels {
  const Plant<double>& plant;
  const std::vector<ParameterColumn>& parameters;
  CommandTerms terms;
};

/// Returns the change of a channel's reading due to the slip. Adds the derivatives of this change
/// to `by_column`, which has one number for each of the `columns` columns of the fit.
double add_wheel_slip(const WheelSlip& slip, const SlippingWheels& wheels,
                      const DelayedCommand& command, const LinearMotion& motion,
                      std::size_t columns, double* by_column);

}  // namespace awmr
