/// Fits of a resistance curve to steady runs: force that was set, rate that was measured. Private
/// to identify/.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/identify/options.h"
#include "awmr/identify/uncertainty/quantiles.h"
#include "awmr/model/family.h"
#include "awmr/model/resistance.h"

namespace awmr {

/// One steady run.
struct SteadyPoint {
  double force = 0.0;               ///< tau_speed, or tau_turn in m; > 0
  double rate = 0.0;                ///< speed in m/s, or yaw rate in rad/s; > 0
  std::optional<double> travel;     ///< distance in m, or angle in rad, where the run was timed
  std::optional<double> elapsed_s;  ///< with `travel`
  int line = 0;
};

/// The coordinates of a fit. alpha goes by its logarithm: it is positive, and its error is a
/// factor.
enum class TransformedParameter { kLogAlpha, kBeta, kCoulomb, kQuadratic, kDeadZone };
inline constexpr std::size_t kTransformedParameterCount = 5;
using TransformedParameters = std::array<double, kTransformedParameterCount>;

/// What is asked of a fit.
struct SteadyProblem {
  std::vector<SteadyPoint> points;
  Family family = Family::kPower;
  ErrorModel noise = ErrorModel::kForce;
  Loss loss = Loss::kSquared;
  Interval beta_range{0.0, 4.0};
};

struct SteadyFit {
  TransformedParameters theta{};           ///< those that the family does not free are 0, beta 1
  std::vector<TransformedParameter> free;  ///< in the family and not held by a bound
  std::vector<TransformedParameter> at_bound;
  Eigen::MatrixXd covariance;  ///< over `free`; 0 x 0 without degrees of freedom
  Eigen::VectorXd residuals;   ///< by point, in the unit of the noise
  Eigen::VectorXd leverages;   ///< by point, in [0, 1]; empty where rank is lacking
  double residual_std = 0.0;   ///< in the unit of the noise; 0 without degrees of freedom
  int degrees_of_freedom = 0;
  int rank = 0;
  double condition_number = 0.0;
  std::string stop_reason;
  bool usable = false;  ///< the search converged, the rank is full

  double operator[](TransformedParameter c) const { return theta[static_cast<std::size_t>(c)]; }
  double& operator[](TransformedParameter c) { return theta[static_cast<std::size_t>(c)]; }
  bool has_covariance() const { return covariance.size() > 0; }
  bool held_by_bound(TransformedParameter c) const;
  /// Of a coordinate: none without degrees of freedom or at a bound.
  std::optional<double> std_error(TransformedParameter c) const;
  Resistance<double> law() const;
};

/// The coordinates that a family frees, in the order of TransformedParameter.
std::vector<TransformedParameter> coordinates_of(Family family);

/// ln f = ln alpha + beta ln w + error, by QR.                                    [paper (48)-(54)]
/// Precondition: at least one point. Rank 1 where all rates are equal.
SteadyFit fit_log_linear(const std::vector<SteadyPoint>& points);

/// The curve with the error where the noise says:
///   log force: ln f = ln (g(w) + z) + error;  force: f = g(w) + z + error;  speed: w = g^-1(f - z)
///   + error;  time: t = travel/g^-1(f - z) + error
/// beta is kept in its range, c, q and z at 0 or more. A robust loss takes its scale from the
/// median absolute residual. Precondition: every point is timed where the noise is kTime.
SteadyFit fit_steady(const SteadyProblem& problem, const TransformedParameters& start);
/// As fit_steady(), from a start that needs no other fit.
SteadyFit fit_steady(const SteadyProblem& problem);

/// Residuals, unweighted, and their derivatives by the coordinates named, anywhere.
struct SteadyRows {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};
SteadyRows steady_rows(const SteadyProblem& problem, const TransformedParameters& at,
                       const std::vector<TransformedParameter>& by);

/// The least sum of squares with one coordinate held. Infinite where the search fails.
double profile_cost(const SteadyProblem& problem, const TransformedParameters& start, TransformedParameter held,
                    double value);
/// Where the profile of the sum of squares rises by t^2 s^2 on either side; an end that a bound
/// cuts off lies on the bound. Precondition: no loss, degrees of freedom, `c` free.
Interval profile_interval(const SteadyProblem& problem, const SteadyFit& fit, TransformedParameter c);

/// AICc = n ln(SSE/n) + 2 k + 2 k (k + 1)/(n - k - 1), k = free coordinates + 1 (the variance).
/// None for n <= k + 1.
std::optional<double> aicc(const SteadyFit& fit);

}  // namespace awmr
