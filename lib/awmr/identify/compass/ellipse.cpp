#include "ellipse.h"

#include <Eigen/LU>
#include <cmath>

#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/ceres_solve.h"

namespace awmr::compass {
namespace {

Ellipse ellipse_of(const Eigen::Vector2d& centre, const Eigen::Matrix2d& gain) {
  Ellipse ellipse;
  ellipse.p << centre, gain(0, 0), gain(0, 1), gain(1, 1);
  return ellipse;
}

/// Initial guess of the ellipse: fits the conic A x^2 + B x y + C y^2 + D x + E y = 1 to the points
/// f = (x, y) by linear least squares. In matrix form this is
///     (f - o)' M (f - o) = k,  M = (A, B/2; B/2, C),  o = -M^-1 (D, E)/2,  k = 1 + o' M o,
/// which equals |S (f - o)| = 1 with S = (M/k)^(1/2). Empty if M/k is not positive definite.
std::optional<Ellipse> conic(const Points& points) {
  Eigen::MatrixXd terms(points.rows(), 5);
  const auto x = points.col(0).array();
  const auto y = points.col(1).array();
  terms << x * x, x * y, y * y, x, y;
  const PivotedQr qr(terms);
  if (qr.rank() < 5) return std::nullopt;
  const Parameters q = qr.solve(Eigen::VectorXd(Eigen::VectorXd::Ones(points.rows())));
  Eigen::Matrix2d m;
  m << q[0], q[1] / 2, q[1] / 2, q[2];
  if (!(m.determinant() > 0.0)) return std::nullopt;
  const Eigen::Vector2d centre = -0.5 * m.inverse() * q.tail<2>();
  const SymmetricEigen shape = symmetric_eigen(m / (1.0 + centre.dot(m * centre)));
  if (!(shape.values.minCoeff() > 0.0)) return std::nullopt;
  return ellipse_of(
      centre, shape.vectors * shape.values.cwiseSqrt().asDiagonal() * shape.vectors.transpose());
}

/// The residuals of all points.
class Distances : public ceres::CostFunction {
 public:
  explicit Distances(const Points& points) : points_(points) {
    set_num_residuals(static_cast<int>(points.rows()));
    mutable_parameter_block_sizes()->push_back(5);
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Ellipse ellipse{Eigen::Map<const Parameters>(parameters[0])};
    for (Eigen::Index i = 0; i < points_.rows(); ++i) {
      residuals[i] = residual(ellipse, points_.row(i));
      if (jacobians == nullptr || jacobians[0] == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, 1, 5>>(jacobians[0] + 5 * i) =
          residual_gradient(ellipse, points_.row(i));
    }
    return true;
  }

 private:
  const Points& points_;
};

}  // namespace

Eigen::Matrix2d Ellipse::gain() const {
  Eigen::Matrix2d gain;
  gain << p[2], p[3], p[3], p[4];
  return gain;
}

Eigen::Vector2d Ellipse::on_circle(const Eigen::Vector2d& f) const {
  return gain() * (f - centre());
}

double residual(const Ellipse& ellipse, const Eigen::Vector2d& f) {
  return ellipse.on_circle(f).norm() - 1.0;
}

Eigen::Matrix<double, 2, 5> circle_gradient(const Ellipse& ellipse, const Eigen::Vector2d& f) {
  const Eigen::Vector2d d = f - ellipse.centre();
  Eigen::Matrix<double, 2, 5> gradient;
  gradient.leftCols<2>() = -ellipse.gain();
  gradient.rightCols<3>() << d[0], d[1], 0.0, 0.0, d[0], d[1];
  return gradient;
}

Eigen::Matrix<double, 1, 5> residual_gradient(const Ellipse& ellipse, const Eigen::Vector2d& f) {
  return ellipse.on_circle(f).normalized().transpose() * circle_gradient(ellipse, f);
}

std::optional<Ellipse> fit_ellipse(const Points& points) {
  // Centres and scales the points, so that all terms of the conic have similar magnitudes.
  const Eigen::RowVector2d mean = points.colwise().mean();
  const double size =
      std::sqrt((points.rowwise() - mean).squaredNorm() / static_cast<double>(points.rows()));
  if (!(size > 0.0)) return std::nullopt;
  const Points scaled = (points.rowwise() - mean) / size;
  std::optional<Ellipse> ellipse = conic(scaled);
  if (!ellipse) return std::nullopt;
  ceres::Problem problem;
  problem.AddResidualBlock(new Distances(scaled), nullptr, ellipse->p.data());
  ceres::Solver::Summary summary;
  ceres::Solve(exact_options(), &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  const Eigen::VectorXd shape = symmetric_eigenvalues(ellipse->gain());
  if (!(shape.minCoeff() > 0.0)) return std::nullopt;
  return ellipse_of(mean.transpose() + size * ellipse->centre(), ellipse->gain() / size);
}

}  // namespace awmr::compass
