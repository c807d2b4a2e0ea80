/// Fit of the mass m' (divided by F_max) to coast-down curves: speed over time with the motors off.
/// Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Starting point of a search.
struct CoastStart {
  double log_mass = 0.0;
  double lag_s = 0.0;  ///< time constant T of the speed sensor's filter; 0: no filter
};

/// Ratio of a term of the surge resistance, c1 or q1, to the coefficient a1. If the surge law is
/// not identified, curves determine only such ratios.
struct TermOverAlpha {
  TransformedParameter term{};  ///< c1 or q1
  double value = 0.0;           ///< c1/a1 in (m/s)^b1, q1/a1 in (m/s)^(b1 - 2); >= 0
  double variance = 0.0;        ///< variance of `value`; 0 if `value` is at a bound
};

/// Time constant T of a low-pass filter in the speed sensor.
struct FittedLag {
  double value_s = 0.0;
  double variance = 0.0;     ///< variance of T, s^2, due to the noise of the curves alone
  Eigen::VectorXd by_surge;  ///< d T / d theta, theta: coordinates of the surge law
};

/// Fit of coast-down curves to
///   m' u_dot = -g1(u), u(0) = u0:
///   u(t)^(1-b) = u0^(1-b) - (1-b) (a/m') t,   u = u0 exp(-(a/m') t) for b -> 1       [paper (58)]
/// for a power law, with a = a1, b = b1 and the time t since the motors were switched off; other
/// families are integrated numerically. If the recorded speed has passed a low-pass filter, the fit
/// compares the record with the filter's output. Each run has its own initial speed u0. If a record
/// begins before the motors are switched off, the fit also estimates the time of switching off.
struct CoastFit {
  double log_mass_norm = 0.0;  ///< ln m'; ln (m'/a1) without a surge law
  double variance = 0.0;       ///< variance of log_mass_norm due to the noise of the curves alone
  double dof = 0.0;            ///< degrees of freedom of `variance`; reduced if residuals correlate
  /// d ln m' / d theta for the free coordinates theta of the fixed surge law (SteadyFit::free).
  Eigen::VectorXd by_surge;
  std::optional<FittedLag> lag;      ///< speed sensor's filter; absent if the fit has none
  double beta = 0.0;                 ///< b1: fitted or given
  double beta_variance = 0.0;        ///< variance of b1; 0 if not fitted or at a bound
  Family family = Family::kPower;    ///< family of a fit without a surge law
  std::vector<TermOverAlpha> terms;  ///< c1/a1, q1/a1 of a fit without a surge law
  std::optional<double> aicc;        ///< AICc of a fit without a surge law
  double residual_std_mps = 0.0;
  int rows = 0;  ///< number of samples of all runs
  int rank = 0;
  /// Condition number of the Jacobian after its columns were scaled to length 1.
  double condition_number = 0.0;
  std::vector<std::vector<double>> residuals;  ///< by run, m/s
  /// True if neighbouring residuals are correlated. `variance` allows for this.
  bool autocorrelated = false;
  bool usable = false;  ///< true if converged, with full rank and degrees of freedom
  std::string stop_reason;
};

/// Fits the mass m' to the curves; the surge law stays fixed. Also fits each run's initial speed,
/// the time constant of the speed filter if `start` has a filter, and, if the record begins before
/// the motors are switched off, the time of switching off.
CoastFit fit_coast(const std::vector<CoastCurve>& curves, const SteadyFit& surge,
                   const CoastStart& start);

/// For a fit with a low-pass filter in the speed sensor (CoastFit::lag): tests whether the curves
/// determine ln m' as well as its standard error says. Fixes ln m' at 3 standard errors below and
/// above the optimum, and fits the other parameters again. A valid standard error predicts that the
/// sum of squares then rises by 9 times the variance of the residuals. If it rises by at least half
/// of that on both sides, the function returns empty. Otherwise another ln m' fits almost as well:
/// the function returns that ln m' and its filter, on the side with the smaller rise, so that the
/// caller can start a fit there.
std::optional<CoastStart> flat_direction(const std::vector<CoastCurve>& curves,
                                         const SteadyFit& surge, const CoastFit& fit);

/// Fits curves if no surge law is identified. The curves then determine only the exponent b1 and
/// the ratios m'/a1 (mass), c1/a1 (Coulomb term) and q1/a1 (quadratic term):
///   (m'/a1) u_dot = -(c1/a1 + |u|^b1 + (q1/a1) u^2)
CoastFit fit_coast_alone(const std::vector<CoastCurve>& curves, const Interval& beta_range,
                         Family family);

}  // namespace awmr
