/// Search of fit_steady() and of profiles. Private to identify/tables/.
#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"

namespace awmr {

/// Ceres problem with one block per coordinate. Variable are the coordinates of the family except
/// `held`. The initial guess is clamped to the bounds. Not movable. `problem` must outlive it.
class SteadySearch {
 public:
  SteadySearch(const SteadyProblem& problem, const TransformedParameters& initial_guess,
               std::optional<TransformedParameter> held);
  SteadySearch(const SteadySearch&) = delete;
  SteadySearch& operator=(const SteadySearch&) = delete;

  /// Minimises until no coordinate changes. A coordinate at a bound is fixed there while the others
  /// are fitted, and freed again if the cost decreases inwards.
  void solve();
  /// Repeats solve() until the scale of the loss, computed from the residuals, has converged.
  void solve_robustly();

  /// By point, in the unit of the noise, without the loss. Empty if the curve cannot be evaluated.
  std::optional<Eigen::VectorXd> residuals();
  /// Points by columns, without the loss. Empty if a derivative is not finite.
  std::optional<Eigen::MatrixXd> jacobian(const std::vector<TransformedParameter>& columns);

  const TransformedParameters& theta() const { return theta_; }
  const ceres::Solver::Summary& summary() const { return summary_; }
  const ceres::LossFunction& loss() const { return loss_; }

 private:
  double* block(TransformedParameter c) { return &theta_[at(c)]; }
  void free_or_hold(std::optional<TransformedParameter> held);
  bool is_at_bound(TransformedParameter c) const;
  std::vector<TransformedParameter> search_until_at_bound();
  bool falls_inwards(TransformedParameter c);

  const SteadyProblem& problem_;
  TransformedParameters theta_;
  std::vector<TransformedParameter> free_;  ///< the variable coordinates
  ceres::LossFunctionWrapper loss_{nullptr, ceres::TAKE_OWNERSHIP};
  std::unique_ptr<ceres::Problem> ceres_;
  ceres::Solver::Summary summary_;
};

}  // namespace awmr
