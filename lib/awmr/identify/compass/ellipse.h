/// The ellipse through points of a plane. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace awmr::compass {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 2>;
/// o_1, o_2, S_11, S_12, S_22
using Parameters = Eigen::Matrix<double, 5, 1>;

/// |S (f - o)| = 1 for the points f of the ellipse; S symmetric and positive definite.
struct Ellipse {
  Parameters p = Parameters::Zero();

  Eigen::Vector2d centre() const { return p.head<2>(); }
  Eigen::Matrix2d gain() const;
  /// c = S (f - o)
  Eigen::Vector2d on_circle(const Eigen::Vector2d& f) const;
};

/// r = |S (f - o)| - 1
double residual(const Ellipse& ellipse, const Eigen::Vector2d& f);
/// dr/dp, a row
Eigen::Matrix<double, 1, 5> residual_gradient(const Ellipse& ellipse, const Eigen::Vector2d& f);
/// dc/dp
Eigen::Matrix<double, 2, 5> circle_gradient(const Ellipse& ellipse, const Eigen::Vector2d& f);

/// The ellipse of least squares of the residuals. Empty if the points determine no ellipse.
std::optional<Ellipse> fit_ellipse(const Points& points);

}  // namespace awmr::compass
