/// m' from whole coast-down curves. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// What the curves are fitted with.
///   m' u_dot = -g1(u), u(0) = u0:
///   u(t)^(1-b) = u0^(1-b) - (1-b) (a/m') t,   u = u0 exp(-(a/m') t) for b -> 1       [paper (58)]
/// for a power law; other families are integrated. Each run has its own u0, and its own moment of
/// motors-off where it was recorded from before that moment.
struct CoastFit {
  double log_mass_norm = 0.0;  ///< ln m'; ln (m'/a1) where the surge law is not known
  double variance = 0.0;       ///< of it, from the curves' noise alone
  double dof = 0.0;
  /// d ln m' / d theta of the surge law held fixed, by SteadyFit::free.
  Eigen::VectorXd by_surge;
  double beta = 0.0;  ///< the exponent, where it was fitted along
  double beta_variance = 0.0;
  double residual_std_mps = 0.0;
  int rows = 0;
  int rank = 0;
  double condition_number = 0.0;
  std::vector<std::vector<double>> residuals;  ///< by run, m/s
  bool autocorrelated = false;  ///< neighbouring residuals are correlated; the variance allows for it
  bool usable = false;
  std::string stop_reason;
};

/// The surge law as it is: only m' and each run's start are fitted.
CoastFit fit_coast(const std::vector<CoastCurve>& curves, const SteadyFit& surge);

/// Without a surge law: m'/a1 and b1, which is all that a curve shows. Precondition: power law.
CoastFit fit_coast_alone(const std::vector<CoastCurve>& curves, const Interval& beta_range);

/// Surge rows and curves together, each weighted by its own noise, which is estimated.
struct JointFit {
  SteadyFit surge;  ///< theta, free, covariance of the joint optimum
  double log_mass_norm = 0.0;
  Eigen::MatrixXd covariance;  ///< over (surge.free, ln m')
  Eigen::VectorXd dof;         ///< Satterthwaite's, by element of the same
  CoastFit coast;              ///< its residuals and noise
};
JointFit fit_joint(const SteadyProblem& surge, const SteadyFit& start,
                   const std::vector<CoastCurve>& curves);

}  // namespace awmr
