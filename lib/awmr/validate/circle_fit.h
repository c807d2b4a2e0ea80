/// Least-squares fit of a circle to points in the plane.
#pragma once

#include <optional>
#include <span>

#include "awmr/control/guidance/position.h"

namespace awmr {

struct Circle {
  double x_m = 0.0;
  double y_m = 0.0;
  double radius_m = 0.0;
  /// Largest | distance to the centre - radius | over the points, m.
  double deviation_m = 0.0;
};

/// Fits a circle by Kasa's method: linear least squares with the centre (cx, cy) and the radius R
/// in
///   x^2 + y^2 = 2 cx x + 2 cy y + (R^2 - cx^2 - cy^2)
/// The fit is exact for points on a circle. For short arcs with noise, the fitted radius is too
/// small. Empty for fewer than three points, or points on a line.
std::optional<Circle> fit_circle(std::span<const Position<double>> points);

}  // namespace awmr
