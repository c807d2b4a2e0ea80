/// Fits of a resistance curve to steady runs with a set force and a measured rate. Private to
/// identify/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/interval.h"
#include "awmr/identify/options.h"
#include "awmr/identify/tables/transformed_parameter.h"
#include "awmr/model/family.h"
#include "awmr/model/resistance.h"

namespace awmr {

/// One steady run. Magnitudes: the resistance is odd, so a turn to the right is its mirror image.
struct SteadyPoint {
  double force = 0.0;               ///< f: tau_speed, 1, or tau_turn, m; > 0
  double rate = 0.0;                ///< w: speed, m/s, or yaw rate, rad/s; > 0
  std::optional<double> travel;     ///< distance, m, or angle, rad, of a timed run; > 0
  std::optional<double> elapsed_s;  ///< with `travel`; > 0
  int line = 0;                     ///< of the file
};

/// Largest number of rows for exact diagnostics. Larger tables are fitted in time and memory
/// proportional to the rows: leaving a row out is one step of the fit instead of a new fit, and
/// intervals are from the standard error.
inline constexpr Eigen::Index kExactRows = 200;

/// Input of a fit: the points, the family of the curve, and the quantity with the error.
struct SteadyProblem {
  std::vector<SteadyPoint> points;  ///< at least one
  Family family = Family::kPower;
  ErrorModel noise = ErrorModel::kForce;
  Loss loss = Loss::kSquared;
  Interval beta_range{0.0, 4.0};  ///< accepted exponents, a bound of the search
};

/// A fitted curve. Unit of the noise: that of force, rate or time, or 1 for the log force.
struct SteadyFit {
  TransformedParameters theta{};  ///< those that are not in the family are 0 (beta: 1)
  /// Free coordinates of the family. A term with the value 0, the end of its range, is included, so
  /// that it contributes to the uncertainty of the others. An exponent at the end of its range is
  /// not included.
  std::vector<TransformedParameter> free;
  std::vector<TransformedParameter> at_bound;
  Eigen::MatrixXd covariance;  ///< free x free, positive definite; 0 x 0 without degrees of freedom
  Eigen::VectorXd residuals;   ///< curve - measured, by point, in the unit of the noise
  Eigen::VectorXd leverages;   ///< by point, in [0, 1]; empty without full rank
  double residual_std = 0.0;   ///< in the unit of the noise; 0 without degrees of freedom
  int degrees_of_freedom = 0;  ///< points - free; may be negative
  int rank = 0;                ///< of the jacobian over `free`
  double condition_number = 0.0;  ///< of the jacobian over the family; infinite without full rank
  std::string stop_reason;
  bool usable = false;  ///< the search converged, the rank is full

  double operator[](TransformedParameter c) const { return theta[at(c)]; }
  double& operator[](TransformedParameter c) { return theta[at(c)]; }
  bool has_covariance() const { return covariance.size() > 0; }
  bool held_by_bound(TransformedParameter c) const;
  /// The standard error of a coordinate; empty without degrees of freedom or for a fixed exponent.
  std::optional<double> std_error(TransformedParameter c) const;
  /// The curve without the dead zone, which belongs to the command.
  Resistance<double> law() const;
};

/// ln f = ln alpha + beta ln w + error, by QR.                                    [paper (48)-(54)]
/// Precondition: at least one point. Rank 1 if all rates are equal.
SteadyFit fit_log_linear(const std::vector<SteadyPoint>& points);

/// Fits the curve with the error of the noise model:
///   log force:  ln f = ln (g(w) + z) + error
///   force:      f = g(w) + z + error
///   speed:      w = g^-1(f - z) + error
///   time:       t = travel/g^-1(f - z) + error
/// beta is kept in its range, c, q and z at 0 or more. A robust loss takes its scale from the
/// median absolute residual. Precondition: every point is timed if the noise is kTime.
SteadyFit fit_steady(const SteadyProblem& problem, const TransformedParameters& initial_guess);
/// The same from initial guesses computed from the points: one of the family's own, and the optimum
/// of each family that this one contains, so that a richer family never fits worse. `known`: optima
/// of the same points, noise and loss, by family; missing ones are added.
SteadyFit fit_steady(const SteadyProblem& problem, std::map<Family, TransformedParameters>& known);

/// The same problem with the error on each run's time, travel/w. Empty if a run was not timed.
std::optional<SteadyProblem> by_time(SteadyProblem problem);

/// True if every coordinate is finite and alpha > 0.
bool is_physical(const Resistance<double>& law);

/// Unweighted residuals and their derivatives by some coordinates, at any point.
struct SteadyRows {
  Eigen::VectorXd residuals;  ///< by point
  Eigen::MatrixXd jacobian;   ///< points x coordinates
};
/// Empty if the curve or a derivative is not finite.
std::optional<SteadyRows> steady_rows(const SteadyProblem& problem,
                                      const TransformedParameters& theta,
                                      const std::vector<TransformedParameter>& by);

/// The bounds of a search over one coordinate; infinite without a bound.
Interval bounds_of(const SteadyProblem& problem, TransformedParameter c);

}  // namespace awmr
