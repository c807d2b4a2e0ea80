/// Least-squares fit of an ellipse to points in a plane. Private to identify/compass/.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace awmr::compass {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 2>;
/// Parameters of an ellipse in the order o_1, o_2, S_11, S_12, S_22 (see Ellipse below).
using Parameters = Eigen::Matrix<double, 5, 1>;

/// Ellipse of the points f with |S (f - o)| = 1: centre o and gain S, a symmetric and positive
/// definite matrix.
struct Ellipse {
  Parameters p = Parameters::Zero();

  Eigen::Vector2d centre() const { return p.head<2>(); }
  Eigen::Matrix2d gain() const;
  /// Maps the ellipse to the unit circle: c = S (f - o).
  Eigen::Vector2d on_circle(const Eigen::Vector2d& f) const;
};

/// Residual r = |S (f - o)| - 1 of a point f.
double residual(const Ellipse& ellipse, const Eigen::Vector2d& f);
/// Gradient dr/dp of the residual r with respect to the parameters p of the ellipse.
Eigen::Matrix<double, 1, 5> residual_gradient(const Ellipse& ellipse, const Eigen::Vector2d& f);
/// Derivatives dc/dp of on_circle(f), a point c on the unit circle, with respect to the parameters
/// p of the ellipse.
Eigen::Matrix<double, 2, 5> circle_gradient(const Ellipse& ellipse, const Eigen::Vector2d& f);

/// Fits the ellipse with the smallest sum of squared residuals. Empty if the points determine none.
std::optional<Ellipse> fit_ellipse(const Points& points);

}  // namespace awmr::compass
