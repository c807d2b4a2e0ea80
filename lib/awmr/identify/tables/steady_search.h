/// Ceres search behind fit_steady() and profile_cost(). Private to identify/tables/.
#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"

namespace awmr {

/// Ceres problem of a table fit, with one parameter block per coordinate. The coordinates of the
/// family are variable, except `held`, which keeps its initial value. Moves the initial guess of a
/// variable coordinate into its bounds. Not movable, because Ceres has pointers to its members.
/// `problem` must outlive the object.
class SteadySearch {
 public:
  SteadySearch(const SteadyProblem& problem, const TransformedParameters& initial_guess,
               std::optional<TransformedParameter> held);
  SteadySearch(const SteadySearch&) = delete;
  SteadySearch& operator=(const SteadySearch&) = delete;

  /// Minimises until no coordinate changes. If a coordinate stays at a bound, fixes it there while
  /// it fits all other coordinates. Reason: if a step crosses a bound, Ceres shortens the step in
  /// all coordinates, and convergence becomes slow. Frees the coordinate again if the cost then
  /// decreases when it moves away from the bound.
  void solve();
  /// Repeats solve() until the coordinates converge. Each round recomputes the scale of the robust
  /// loss from the residuals.
  void solve_robustly();

  /// Residuals, one per point, in the unit of the noise, without the weights of the robust loss.
  /// Empty if one of them is not finite.
  std::optional<Eigen::VectorXd> residuals();
  /// Derivatives of the residuals with respect to the coordinates `columns`: a row per point, a
  /// column per coordinate, without the weights of the robust loss. Empty if one of them is not
  /// finite.
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
