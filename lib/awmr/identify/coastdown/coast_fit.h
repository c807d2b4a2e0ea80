/// m' from whole coast-down curves. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// A family's term over a1, which is all that curves show of it without a surge law.
struct TermOverAlpha {
  TransformedParameter term{};  ///< c1 or q1
  double value = 0.0;           ///< c1/a1 in (m/s)^b1, q1/a1 in (m/s)^(b1 - 2); >= 0
  double variance = 0.0;        ///< 0 where it came out as 0, the end of its range
};

/// Fit of coast-down curves to
///   m' u_dot = -g1(u), u(0) = u0:
///   u(t)^(1-b) = u0^(1-b) - (1-b) (a/m') t,   u = u0 exp(-(a/m') t) for b -> 1       [paper (58)]
/// for a power law; other families are integrated. Each run has its own u0, and its own moment of
/// motors-off where it was recorded from before that moment.
struct CoastFit {
  double log_mass_norm = 0.0;  ///< ln m'; ln (m'/a1) where the surge law is not known
  double variance = 0.0;       ///< of it, from the curves' noise alone
  double dof = 0.0;            ///< degrees of freedom of that variance, fewer where autocorrelated
  /// d ln m' / d theta of the surge law held fixed, by SteadyFit::free.
  Eigen::VectorXd by_surge;
  double beta = 0.0;                 ///< b1: the exponent, where it was fitted along, else as given
  double beta_variance = 0.0;        ///< 0 where it was not fitted or lies on a bound
  Family family = Family::kPower;    ///< without a surge law: the family that was fitted
  std::vector<TermOverAlpha> terms;  ///< without a surge law: those of the family
  std::optional<double> aicc;        ///< without a surge law; less is better
  double residual_std_mps = 0.0;
  int rows = 0;  ///< samples of all runs
  int rank = 0;
  double condition_number = 0.0;               ///< columns scaled to length one
  std::vector<std::vector<double>> residuals;  ///< by run, m/s
  bool autocorrelated =
      false;            ///< neighbouring residuals are correlated; the variance allows for it
  bool usable = false;  ///< converged, with full rank and degrees of freedom
  std::string stop_reason;
};

/// The surge law as it is: only m' and each run's initial state are fitted.
CoastFit fit_coast(const std::vector<CoastCurve>& curves, const SteadyFit& surge);

/// Without a surge law: m'/a1, b1 and the family's terms over a1, which is all that a curve shows:
///   (m'/a1) u_dot = -(c1/a1 + |u|^b1 + (q1/a1) u^2)
/// A dead zone does not enter, as the motors are off.
CoastFit fit_coast_alone(const std::vector<CoastCurve>& curves, const Interval& beta_range,
                         Family family);

}  // namespace awmr
