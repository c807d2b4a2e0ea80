#include "awmr/identify/coastdown/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/identify/ceres_solve.h"
#include "awmr/identify/coastdown/coast_noise.h"
#include "awmr/identify/coastdown/coast_problem.h"

namespace awmr {
namespace {

constexpr int kMaximumRounds = 200;
/// The fit has converged when two numbers are below this: the largest change of a parameter in the
/// last step, divided by its standard error; and the largest relative change of the two noise
/// variances.
constexpr double kTolerance = 1e-8;

struct BySet {
  double surge = 0.0;
  double coast = 0.0;
};

/// Columns of the Jacobian of the curves. First come the parameters that the surge rows determine
/// as well: the surge law without the dead zone, which has no effect in a coast-down. Then follow
/// ln m' and the filter's time constant (CoastProblem::own_blocks()).
struct SharedColumns {
  std::vector<double*> blocks;         ///< parameter blocks of CoastProblem
  std::vector<Eigen::Index> of_surge;  ///< column of each block of the law in the surge Jacobian
};

/// Residuals and Jacobians of the surge rows and of the curves, at one point.
struct Rows {
  SteadyRows surge;
  Eigen::VectorXd coast_residuals;
  Eigen::MatrixXd coast_jacobian;  ///< columns: SharedColumns, then the initial states
};

/// Jacobians of the residuals of the surge runs (`surge`) and of the coast-down curves (`coast`),
/// both with respect to one parameter vector (parameters of the surge law, ln m', initial states),
/// and the covariance of this vector.
struct Stacked {
  Eigen::MatrixXd surge;
  Eigen::MatrixXd coast;
  Eigen::MatrixXd covariance;
};

SharedColumns shared_columns(CoastProblem& problem, const std::vector<TransformedParameter>& free) {
  SharedColumns shared;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i] == TransformedParameter::kDeadZone) continue;
    shared.blocks.push_back(problem.block(free[i]));
    shared.of_surge.push_back(eigen_index(i));
  }
  for (double* own : problem.own_blocks()) shared.blocks.push_back(own);
  return shared;
}

/// Covariance C = (Js^T Js / vs + Jc^T Jc / vc)^-1, with the Jacobian J and the noise variance v of
/// the surge rows (s) and of the curves (c).
Stacked stack(const Rows& rows, const SharedColumns& shared, const BySet& variance) {
  const Eigen::Index p = rows.surge.jacobian.cols();
  const Eigen::Index own = rows.coast_jacobian.cols() - rows_of(shared.of_surge);
  Stacked stacked;
  stacked.surge = Eigen::MatrixXd::Zero(rows.surge.residuals.size(), p + own);
  stacked.surge.leftCols(p) = rows.surge.jacobian;
  stacked.coast = Eigen::MatrixXd::Zero(rows.coast_jacobian.rows(), p + own);
  for (std::size_t i = 0; i < shared.of_surge.size(); ++i) {
    stacked.coast.col(shared.of_surge[i]) = rows.coast_jacobian.col(eigen_index(i));
  }
  stacked.coast.rightCols(own) = rows.coast_jacobian.rightCols(own);
  const Eigen::MatrixXd information = stacked.surge.transpose() * stacked.surge / variance.surge +
                                      stacked.coast.transpose() * stacked.coast / variance.coast;
  stacked.covariance = solve_ldlt(information, Eigen::MatrixXd::Identity(p + own, p + own));
  return stacked;
}

/// Gauss-Newton step -C (Js^T es / vs + Jc^T ec / vc), with the residuals es and ec.
Eigen::VectorXd gauss_newton_step(const Stacked& s, const Rows& rows, const BySet& variance) {
  return -s.covariance * (s.surge.transpose() * rows.surge.residuals / variance.surge +
                          s.coast.transpose() * rows.coast_residuals / variance.coast);
}

/// Residual degrees of freedom n - tr(C J^T J)/v of the surge rows and of the curves: the number n
/// of rows minus the effective number of parameters that these rows determine.
BySet degrees_of_freedom(const Stacked& s, const Rows& rows, const BySet& variance) {
  const double surge_spent =
      (s.covariance * (s.surge.transpose() * s.surge)).trace() / variance.surge;
  const double coast_spent =
      (s.covariance * (s.coast.transpose() * s.coast)).trace() / variance.coast;
  return {static_cast<double>(rows.surge.residuals.size()) - surge_spent,
          static_cast<double>(rows.coast_residuals.size()) - coast_spent};
}

/// Noise variances e^T e / dof of the surge rows and of the curves.
BySet variance_components(const Rows& rows, const BySet& dof) {
  return {rows.surge.residuals.squaredNorm() / std::max(1.0, dof.surge),
          rows.coast_residuals.squaredNorm() / std::max(1.0, dof.coast)};
}

/// Effective degrees of freedom (Satterthwaite) of the first `count` variances V = Vs + Vc, with
/// the contribution Vs of the surge rows and Vc of the curves:
///   V^2 / (Vs^2/dof_s + Vc^2/dof_c)
Eigen::VectorXd satterthwaite(const Stacked& s, const BySet& variance, const BySet& dof,
                              Eigen::Index count) {
  const Eigen::MatrixXd by_surge =
      s.covariance * (s.surge.transpose() * s.surge) * s.covariance / variance.surge;
  const Eigen::MatrixXd by_coast =
      s.covariance * (s.coast.transpose() * s.coast) * s.covariance / variance.coast;
  Eigen::VectorXd combined = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double total = by_surge(i, i) + by_coast(i, i);
    combined(i) = total * total /
                  (by_surge(i, i) * by_surge(i, i) / std::max(1.0, dof.surge) +
                   by_coast(i, i) * by_coast(i, i) / std::max(1.0, dof.coast));
  }
  return combined;
}

/// Larger of the relative changes of the two noise variances, from one round to the next.
double change(const BySet& from, const BySet& to) {
  return std::max(std::abs(to.surge / from.surge - 1.0), std::abs(to.coast / from.coast - 1.0));
}

/// Largest element of a step of the parameters, each divided by its standard error.
double length(const Eigen::VectorXd& step, const Stacked& s) {
  return (step.array() / s.covariance.diagonal().array().sqrt()).abs().maxCoeff();
}

double mean_square(const Eigen::VectorXd& e) {
  return e.squaredNorm() / static_cast<double>(e.size());
}

/// Copies the current state of the search into `joint`. Called in every round, so that a search
/// that does not converge also leaves its last state.
void keep(const Stacked& s, const Rows& rows, CoastProblem& problem, const BySet& variance,
          const BySet& dof, const std::vector<CoastCurve>& curves, JointFit& joint) {
  const Eigen::Index count = rows_of(joint.surge.free) + 1;
  joint.covariance = s.covariance.topLeftCorner(count, count);
  joint.dof = satterthwaite(s, variance, dof, count);
  joint.log_mass_norm = *problem.log_mass();
  joint.coast.residuals = by_run(rows.coast_residuals, curves);
  joint.coast.residual_std_mps = std::sqrt(variance.coast);
  joint.coast.rows = static_cast<int>(rows.coast_residuals.size());
  if (*problem.lag_s() > 0.0) {
    joint.coast.lag = {*problem.lag_s(), s.covariance(count, count), {}};
  }
  joint.surge.covariance = joint.covariance.topLeftCorner(count - 1, count - 1);
}

/// Residuals and Jacobians of the surge rows and of the curves, at the current parameters. Empty if
/// one of them is not finite.
std::optional<Rows> rows_at(const SteadyProblem& surge, const TransformedParameters& theta,
                            const std::vector<TransformedParameter>& free,
                            const SharedColumns& shared, CoastProblem& problem) {
  std::optional<Eigen::MatrixXd> jacobian = problem.jacobian(shared.blocks);
  std::optional<Eigen::VectorXd> residuals = problem.residuals();
  std::optional<SteadyRows> surge_rows = steady_rows(surge, theta, free);
  if (!jacobian || !residuals || !surge_rows) return std::nullopt;
  return Rows{std::move(*surge_rows), std::move(*residuals), std::move(*jacobian)};
}

JointFit not_finite(JointFit joint) {
  joint.coast.usable = false;
  joint.coast.stop_reason = kNotFinite;
  joint.surge.stop_reason = kNotFinite;
  joint.covariance.resize(0, 0);
  return joint;
}

}  // namespace

JointFit fit_joint(const SteadyProblem& surge, const SteadyFit& alone,
                   const std::vector<CoastCurve>& curves, const CoastStart& start) {
  JointFit joint;
  joint.surge = alone;
  const FamilyTerms terms = terms_of(surge.family);
  CoastProblem problem(curves, alone.theta, start, terms.coulomb || terms.quadratic);
  problem.solve();  // fits ln m' and the initial states; the surge law is fixed
  const SharedColumns shared = shared_columns(problem, alone.free);
  const std::optional<Eigen::VectorXd> initial = problem.residuals();
  BySet variance{alone.residual_std * alone.residual_std, initial ? mean_square(*initial) : 0.0};
  joint.coast.stop_reason = "not converged: the step is still above 1e-8 standard errors";
  // Each round takes its noise variances from the residuals of the round before.
  for (int round = 0; round < kMaximumRounds && !joint.coast.usable; ++round) {
    joint.surge.theta = problem.theta();
    const std::optional<Rows> evaluated =
        rows_at(surge, joint.surge.theta, alone.free, shared, problem);
    if (!evaluated) return not_finite(std::move(joint));
    const Rows& rows = *evaluated;
    const Stacked s = stack(rows, shared, variance);
    const Eigen::VectorXd step = gauss_newton_step(s, rows, variance);
    const BySet dof = degrees_of_freedom(s, rows, variance);
    if (!s.covariance.allFinite() || !step.allFinite()) return not_finite(std::move(joint));
    keep(s, rows, problem, variance, dof, curves, joint);
    const BySet next = variance_components(rows, dof);
    if (length(step, s) < kTolerance && change(variance, next) < kTolerance) {
      joint.coast.usable = true;
      joint.coast.stop_reason = "converged: steps below 1e-8 standard errors";
      joint.surge.residual_std = std::sqrt(next.surge);
      joint.surge.residuals = rows.surge.residuals;
    } else {
      problem.step(alone.free, step);
    }
    variance = next;
  }
  joint.surge.stop_reason = joint.coast.stop_reason;
  return joint;
}

}  // namespace awmr
