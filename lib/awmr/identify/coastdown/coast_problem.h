/// Least-squares problem of all coast-down curves. Private to identify/coastdown/.
#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/tables/steady_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Speed u0 and time t0 of motors-off of a run. If the record begins before motors-off, the speed
/// begins with a plateau; its mean and its end are the initial guesses of u0 and t0. Otherwise u0
/// starts at the first sample's speed, and t0 is fixed at the first sample's time.
struct CoastInitialState {
  double block[2];         ///< u0 in m/s, t0 in s
  bool free_time = false;  ///< true if t0 is fitted
};

/// Residuals u(t) - measured of every sample, run after run. Parameters: the surge law (ln a, b, c,
/// q), ln m' and each run's (u0, t0). The surge law is constant unless the caller sets its
/// parameter blocks variable. Not movable, because the problem has pointers to its members.
/// `curves` must outlive this object.
class CoastProblem {
 public:
  /// `terms_free`: true if c or q will be fitted. The curve is then integrated numerically, because
  /// its closed form has no derivative by c or q.
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

  /// Residuals by sample, m/s; empty if one is not finite.
  std::optional<Eigen::VectorXd> residuals();
  /// Jacobian, samples x columns. The columns are the blocks `first` in their order, then each
  /// run's u0, and t0 if free. Empty if a derivative is not finite.
  std::optional<Eigen::MatrixXd> jacobian(const std::vector<double*>& first);

  /// Adds the step `by` to the coordinates `free`, ln m' and each run's initial state, in that
  /// order.
  void step(const std::vector<TransformedParameter>& free, const Eigen::VectorXd& by);

  const std::vector<int>& sizes() const { return sizes_; }  ///< number of samples, by run

 private:
  const std::vector<CoastCurve>* curves_;
  TransformedParameters theta_;
  double log_mass_;
  std::vector<CoastInitialState> initial_;
  std::vector<int> sizes_;
  ceres::Problem problem_;
  ceres::Solver::Summary summary_;
};

/// Initial guess of ln m' from the first curve that falls from 90 % to 50 % of its highest speed,
/// du in the time dt: m' ~ g(u) dt/|du|, with u at 70 %. Without such a curve: ln 0.1.
double guess_log_mass(const std::vector<CoastCurve>& curves, const Resistance<double>& law);

}  // namespace awmr
