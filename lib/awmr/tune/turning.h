/// Checks whether the motors can turn the vehicle at all: compares the largest yaw moment of each
/// mode with the yaw resistance at a small yaw rate. Private to tune/.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "awmr/core/result.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/constraints.h"

namespace awmr {

/// Yaw moments of one mode at the speed u_d.
struct TurningMoment {
  YawMode mode{};
  double speed_mps = 0.0;    ///< u_d
  double available_m = 0.0;  ///< the largest moment
  /// Moment needed to turn: the yaw resistance g3 at kSlowest_radps, plus tyre scrub. The scrub
  /// moment is multiplied by the share of `available_m` that the difference of left and right wheel
  /// forces makes.
  double needed_m = 0.0;

  bool turns() const { return available_m > needed_m; }
};

/// Returns the yaw moments of a mode. The largest moments are
///   steering      l_f g1(u_d) tan(d_max/2), because the steady speed needs the thrust g1(u_d)
///   differential  n d (F'max - F'min)/2, n the number of driven wheels
///   combined      the sum of both
/// F'max and F'min are the limits of the wheel force after subtracting the dead zone; with
/// front-wheel drive, tan(d_max) replaces tan(d_max/2).
TurningMoment turning_moment(const DrawnVehicle& vehicle, double speed_mps, YawMode mode);

/// Checks that the vehicle can turn in at least one mode and scenario. Errors (refused): it cannot.
/// Precondition: the scenarios have heading guidance.
Status check_turning(const DrawnVehicle& vehicle, std::span<const YawMode> modes,
                     std::span<const Scenario> scenarios, const std::string& model_file);

}  // namespace awmr
