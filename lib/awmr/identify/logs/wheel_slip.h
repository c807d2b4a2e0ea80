/// Slip of wheels whose rotation measures the speed or the yaw rate, with derivatives. Private to
/// identify/.
///
/// A wheel that pushes rolls faster than the ground passes below it. Where the ground passes with
/// w = u -+ d r (left, right), the wheels of a side with the force F' roll at
///
///     w + s F'        (in m/s at F' = 1; 0 where the wheel stands)
///     w + s F' |w|    (s is the slip ratio at F' = 1; WheelSlip::is_ratio)
///
/// The speed is the mean of both sides, and the yaw rate is their difference over 2 d. F' is the
/// force after the motors' lag, dead zone and back-EMF.
#pragma once

#include <vector>

#include "awmr/identify/logs/linear_replay.h"

namespace awmr {

/// Slip s of the wheels that measure a channel, and the column of its derivatives.
struct WheelSlip {
  LogChannel channel;  ///< speed or yaw rate
  OffsetColumn slip;
  bool is_ratio;
};

/// The vehicle, and the columns of the derivatives of the fit.
struct SlippingWheels {
  const Plant<double>& plant;
  const std::vector<ParameterColumn>& parameters;
  CommandColumns columns;
};

/// Returns what the slip adds to the reading of its channel, and adds the derivatives to
/// `by_column` (`columns` numbers).
double add_wheel_slip(const WheelSlip& slip, const SlippingWheels& wheels,
                      const DelayedCommand& command, const LinearMotion& motion,
                      std::size_t columns, double* by_column);

}  // namespace awmr
