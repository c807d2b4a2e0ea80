#include "awmr/validate/circle_fit.h"

#include <algorithm>
#include <cmath>

namespace awmr {

std::optional<Circle> fit_circle(std::span<const Position<double>> points) {
  if (points.size() < 3) return std::nullopt;
  const double n = static_cast<double>(points.size());
  Position<double> mean{};
  for (const Position<double>& p : points) {
    mean.x_m += p.x_m / n;
    mean.y_m += p.y_m / n;
  }
  // Normal equations of the fit. x, y: coordinates relative to the mean of the n points; (cx, cy):
  // centre of the circle; R: its radius; z = x^2 + y^2. Sxy is the sum of x y over the points; Sxx,
  // Syy, Sxz and Syz likewise.
  //   [Sxx Sxy] [cx]   1 [Sxz]
  //   [Sxy Syy] [cy] = - [Syz]    and  R^2 = cx^2 + cy^2 + (Sxx + Syy)/n.
  //                    2
  double sxx = 0.0, sxy = 0.0, syy = 0.0, sxz = 0.0, syz = 0.0;
  for (const Position<double>& p : points) {
    const double x = p.x_m - mean.x_m;
    const double y = p.y_m - mean.y_m;
    const double z = x * x + y * y;
    sxx += x * x;
    sxy += x * y;
    syy += y * y;
    sxz += x * z;
    syz += y * z;
  }
  const double determinant = sxx * syy - sxy * sxy;
  // For points on a line, one eigenvalue of the matrix [Sxx Sxy; Sxy Syy] is 0 except for rounding.
  if (!(determinant > 1e-12 * (sxx + syy) * (sxx + syy))) return std::nullopt;
  const double cx = 0.5 * (syy * sxz - sxy * syz) / determinant;
  const double cy = 0.5 * (sxx * syz - sxy * sxz) / determinant;
  Circle circle{.x_m = mean.x_m + cx,
                .y_m = mean.y_m + cy,
                .radius_m = std::sqrt(cx * cx + cy * cy + (sxx + syy) / n)};
  for (const Position<double>& p : points) {
    const double distance = std::hypot(p.x_m - circle.x_m, p.y_m - circle.y_m);
    circle.deviation_m = std::max(circle.deviation_m, std::abs(distance - circle.radius_m));
  }
  return circle;
}

}  // namespace awmr
