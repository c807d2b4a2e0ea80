/// Fits of f = alpha w^beta to steady points, in (ln alpha, beta). Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/identify/identify.h"

namespace awmr {

/// One steady run: a force that was set, a speed or yaw rate that was measured.
struct PowerLawPoint {
  double force = 0.0;               ///< tau_speed, or tau_turn in m; > 0
  double rate = 0.0;                ///< speed in m/s, or yaw rate in rad/s; > 0
  std::optional<double> travel;     ///< distance in m, or angle in rad, where the run was timed
  std::optional<double> elapsed_s;  ///< with `travel`
};

struct PowerLawFit {
  double log_alpha = 0.0;
  double beta = 0.0;
  /// Over (ln alpha, beta); absent without degrees of freedom. A parameter held by its bound has
  /// zero variance here and `beta_at_bound` set.
  std::optional<Eigen::Matrix2d> covariance;
  bool beta_at_bound = false;
  double residual_std = 0.0;  ///< in the unit of the noise; 0 without degrees of freedom
  int degrees_of_freedom = 0;
  int rank = 0;
  double condition_number = 0.0;
  std::string stop_reason;
  bool usable = false;  ///< the search converged (nonlinear), the rank is full
};

/// ln f = ln alpha + beta ln w + error, by QR.                                [paper (48)-(54)]
/// Precondition: at least one point. Rank 1 where all rates are equal.
PowerLawFit fit_log_linear(const std::vector<PowerLawPoint>& points);

/// The same law with the error where `noise` says:
///   force: f = alpha w^beta + error;  speed: w = (f/alpha)^(1/beta) + error;
///   time:  t = travel (f/alpha)^(-1/beta) + error
/// beta is kept in `beta_range`. Precondition: every point is timed where noise is kTime.
PowerLawFit fit_nonlinear(const std::vector<PowerLawPoint>& points, Noise noise,
                          const Interval& beta_range, const PowerLawFit& start);

/// The half width of a 95 % interval over its standard error: Student's t with these degrees of
/// freedom.
double t_quantile_95(int degrees_of_freedom);

}  // namespace awmr
