/// Least-squares problem of all coast-down curves. Private to identify/coastdown/.
#pragma once

#include <ceres/ceres.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/coastdown/coast_fit.h"
#include "awmr/identify/tables/steady_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Time t0 at which a run's motors were switched off, and the speed u0 at that time. If the record
/// begins earlier, the speed begins with a plateau (constant speed). The mean of the plateau is the
/// initial guess of u0, and the end of the plateau that of t0. If no plateau is detected, u0 starts
/// at the first sample's speed, and t0 is fixed at the first sample's time. A short plateau may go
/// undetected, so the solver also tries to fit t0 and keeps that fit if it lowers AIC.
struct CoastInitialState {
  double block[2];         ///< u0 in m/s, t0 in s
  bool free_time = false;  ///< true if t0 is fitted
  /// Initial guess of t0 if no plateau was detected. Absent if one was detected, or if too few
  /// samples follow to fit t0.
  std::optional<double> short_lead_s;
};

/// Residuals u(t) - measured of every sample, run after run. Parameters: the surge law (ln a, b, c,
/// q), ln m', T and each run's (u0, t0). The surge law is constant unless the caller sets its
/// parameter blocks variable. If the fit has a filter of the speed sensor, with the output y and
/// the time constant T, the residuals are y(t) - measured:
///
///     T y' = u - y,   y = u0 until t0
///
/// Not movable, because the problem has pointers to its members. `curves` must outlive this object.
class CoastProblem {
 public:
  /// `terms_free`: true if c or q will be fitted. The curve is then integrated numerically: its
  /// closed form is only for power laws, so it has no derivative with respect to c or q.
  CoastProblem(const std::vector<CoastCurve>& curves, const TransformedParameters& surge,
               const CoastStart& start, bool terms_free);
  CoastProblem(const CoastProblem&) = delete;
  CoastProblem& operator=(const CoastProblem&) = delete;

  ceres::Problem& problem() { return problem_; }
  double* block(TransformedParameter c) { return &theta_[at(c)]; }
  double* log_mass() { return &at_.log_mass; }
  double* lag_s() { return &at_.lag_s; }
  /// Parameter blocks of ln m' and, if there is a filter, of its time constant T.
  std::vector<double*> own_blocks();
  const TransformedParameters& theta() const { return theta_; }

  /// Frees the coordinates `free` of the surge law, with a normal prior around the given law.
  /// `covariance`: covariance of this prior. `noise_mps`: standard deviation of the curves' noise.
  /// The residuals of the prior are multiplied by `noise_mps`, because the residuals of the curves
  /// are in m/s.
  void free_law(const std::vector<TransformedParameter>& free, const Eigen::MatrixXd& covariance,
                double noise_mps);
  /// Squared distance of the current surge law from the given one, in standard errors (Mahalanobis
  /// distance with the covariance passed to free_law()). 0 if the law is fixed.
  double law_distance() const;

  void solve();
  const ceres::Solver::Summary& summary() const { return summary_; }

  /// Residuals of all samples, m/s. Empty if one of them is not finite.
  std::optional<Eigen::VectorXd> residuals();
  /// Jacobian of the residuals: a row per sample, a column per parameter. The first columns belong
  /// to the parameter blocks `first`, in their order. Then follow each run's u0 and, if it is
  /// fitted, t0. Empty if an element is not finite.
  std::optional<Eigen::MatrixXd> jacobian(const std::vector<double*>& first);

  /// Adds the step `by` to the coordinates `free`, own_blocks() and each run's initial state, in
  /// that order.
  void step(const std::vector<TransformedParameter>& free, const Eigen::VectorXd& by);

  /// Number of free parameters without those of the surge law: ln m', T if there is a filter, each
  /// run's u0 and, if it is fitted, t0.
  int free_count() const;

 private:
  void minimise();
  void search();
  void free_short_leads();
  void fix_time(std::size_t run);

  const std::vector<CoastCurve>* curves_;
  TransformedParameters theta_;
  CoastStart at_;
  std::vector<TransformedParameter> law_free_;
  TransformedParameters given_law_;
  Eigen::MatrixXd law_root_;  ///< R; R^T R is the inverse of the prior's covariance
  std::vector<CoastInitialState> initial_;
  Eigen::Index rows_ = 0;
  ceres::Problem problem_;
  ceres::Solver::Summary summary_;
};

double highest_speed_mps(const std::vector<CoastCurve>& curves);

/// Time constant of the deceleration, m' u0/g(u0), s, at the highest speed u0 of the curves; g:
/// surge resistance.
double fall_time_s(const std::vector<CoastCurve>& curves, const Resistance<double>& law,
                   double log_mass);

/// Initial guess of ln m', from the first curve whose speed falls from 90 % to 50 % of its highest
/// value. If this decrease du takes the time dt, m' is about g dt/du, with the resistance g at 70 %
/// of the highest speed. Returns ln 0.1 if no curve falls so far.
double guess_log_mass(const std::vector<CoastCurve>& curves, const Resistance<double>& law);

}  // namespace awmr
