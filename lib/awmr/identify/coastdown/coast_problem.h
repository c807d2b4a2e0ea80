/// All coast-down curves as one least-squares problem. Private to identify/coastdown/.
#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/tables/steady_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Initial state of a run: mean and end of the plateau, if it was recorded from before motors-off.
struct CoastInitialState {
  double block[2];         ///< u0 in m/s, t0 in s
  bool free_time = false;  ///< t0 is fitted
};

/// The residuals u(t) - measured of every sample, run after run, over the surge law's ln a, b, c,
/// q, ln m' and each run's (u0, t0). The surge law is constant unless its blocks are set variable.
/// Not movable: the problem has pointers to its members and to `curves`.
class CoastProblem {
 public:
  /// `terms_free`: derivatives by c or q can be requested, which the closed form does not give.
  CoastProblem(const std::vector<CoastCurve>& curves, const TransformedParameters& surge,
               double log_mass, bool terms_free);
  CoastProblem(const CoastProblem&) = delete;
  CoastProblem& operator=(const CoastProblem&) = delete;

  ceres::Problem& problem() { return problem_; }
  double* block(TransformedParameter c) { return &theta_[at(c)]; }
  double* log_mass() { return &log_mass_; }
  const TransformedParameters& theta() const { return theta_; }

  void solve();
  const ceres::Solver::Summary& summary() const { return summary_; }

  /// m/s, by sample; empty if one is not finite.
  std::optional<Eigen::VectorXd> residuals();
  /// Samples by columns: `first` in order, then each run's initial state (u0, and t0 where free).
  /// Empty if a derivative is not finite.
  std::optional<Eigen::MatrixXd> jacobian(const std::vector<double*>& first);

  /// Moves theta, ln m' and each run's initial state, in that order.
  void step(const std::vector<TransformedParameter>& free, const Eigen::VectorXd& by);

  const std::vector<int>& sizes() const { return sizes_; }  ///< samples, by run

 private:
  const std::vector<CoastCurve>* curves_;
  TransformedParameters theta_;
  double log_mass_;
  std::vector<CoastInitialState> initial_;
  std::vector<int> sizes_;
  ceres::Problem problem_;
  ceres::Solver::Summary summary_;
};

/// An initial guess of ln m' from the deceleration at the beginning of the curves and g1 there:
///   m' ~ g(u) dt/du
double guess_log_mass(const std::vector<CoastCurve>& curves, const Resistance<double>& law);

}  // namespace awmr
