/// Fits a circle to points.
#pragma once

#include <optional>
#include <span>

namespace awmr {

struct Point {
  double x_m = 0.0;
  double y_m = 0.0;
};

struct Circle {
  double x_m = 0.0;
  double y_m = 0.0;
  double radius_m = 0.0;
  /// Largest | distance to the centre - radius | over the points, m.
  double deviation_m = 0.0;
};

/// Least squares on  x^2 + y^2 = 2 cx x + 2 cy y + (R^2 - cx^2 - cy^2)  (Kasa's algebraic fit:
/// exact for exact circles, linear, biased to small radii only for short noisy arcs). Nothing for
/// fewer than three points or points on a line.
std::optional<Circle> fit_circle(std::span<const Point> points);

}  // namespace awmr
