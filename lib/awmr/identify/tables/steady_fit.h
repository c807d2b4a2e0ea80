/// Fits of a resistance curve to the rows of a table: steady runs, each with a set force and a
/// measured rate (speed or yaw rate). Private to identify/.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/interval.h"
#include "awmr/identify/options.h"
#include "awmr/model/family.h"
#include "awmr/model/resistance.h"

namespace awmr {

/// Coordinates of the curve alpha w^beta + c + q w^2 = f - z, with the force f, the dead zone z and
/// the rate w. alpha is positive with a relative error, so its coordinate is ln alpha.
enum class TransformedParameter {
  kLogAlpha,   ///< ln alpha, unbounded
  kBeta,       ///< beta (no unit), within the accepted range
  kCoulomb,    ///< c, >= 0
  kQuadratic,  ///< q, >= 0
  kDeadZone,   ///< z = 4 F'0: part of tau_speed lost in the dead zones F'0 of four wheels, >= 0
};
inline constexpr std::size_t kTransformedParameterCount = 5;
/// One number for each TransformedParameter, in its order.
using TransformedParameters = std::array<double, kTransformedParameterCount>;

/// Coordinates that are free in a family, in the order of TransformedParameter.
std::vector<TransformedParameter> coordinates_of(Family family);

/// Value of the model parameter at a coordinate: alpha = exp(ln alpha), F'0 = z/4, others
/// unchanged.
double value_from(TransformedParameter c, double coordinate);
Interval values_from(TransformedParameter c, const Interval& coordinate);
/// d value_from(c, coordinate) / d coordinate.
double jacobian_of(TransformedParameter c, double coordinate);

/// One steady run. All values are magnitudes, because the resistance is odd: turns to the left and
/// to the right are equivalent.
struct SteadyPoint {
  double force = 0.0;               ///< f: tau_speed (no unit) or tau_turn (m), > 0
  double rate = 0.0;                ///< w: speed (m/s) or yaw rate (rad/s), > 0
  std::optional<double> travel;     ///< distance (m) or angle (rad) of a timed run, > 0
  std::optional<double> elapsed_s;  ///< time for `travel`, s; > 0
  int line = 0;                     ///< line number in the file
};

/// Largest number of rows with exact diagnostics. In larger tables, one step from the fit of all
/// rows approximates the fit without a row, and there are no profile intervals. Exact diagnostics
/// of large tables would take too long: their time and memory grow faster than the number of rows.
inline constexpr Eigen::Index kExactRows = 200;

/// Input of a fit: the runs, the family of the curve, the error model and the loss.
struct SteadyProblem {
  std::vector<SteadyPoint> points;  ///< at least one
  Family family = Family::kPower;
  ErrorModel noise = ErrorModel::kForce;
  Loss loss = Loss::kSquared;
  Interval beta_range{0.0, 4.0};  ///< accepted exponents: the bounds of the search
};

/// A fitted curve. "Unit of the noise" below is the unit of the quantity that has the error (force,
/// rate or time; 1 for the logarithm of the force).
struct SteadyFit {
  TransformedParameters theta{};  ///< fitted coordinates; 0 (beta: 1) for terms outside the family
  /// Free coordinates of the family. Includes a term whose search ended at its lower bound 0, so
  /// that it contributes to the uncertainty of the other coordinates. Excludes an exponent at a
  /// bound.
  std::vector<TransformedParameter> free;
  std::vector<TransformedParameter> at_bound;  ///< coordinates whose search ended at a bound
  /// Covariance of the coordinates in `free`, positive definite; 0 x 0 without degrees of freedom.
  Eigen::MatrixXd covariance;
  Eigen::VectorXd residuals;   ///< one per point: curve - measured, in the unit of the noise
  Eigen::VectorXd leverages;   ///< one per point, in [0, 1]; empty if rank deficient
  double residual_std = 0.0;   ///< in the unit of the noise; 0 without degrees of freedom
  int degrees_of_freedom = 0;  ///< number of points minus free; may be negative
  int rank = 0;                ///< rank of the Jacobian by the coordinates in `free`
  /// Condition number of the Jacobian with all coordinates; infinite if it is rank deficient.
  double condition_number = 0.0;
  std::string stop_reason;
  bool usable = false;  ///< the search converged, and the Jacobian has full rank

  double operator[](TransformedParameter c) const { return theta[at(c)]; }
  double& operator[](TransformedParameter c) { return theta[at(c)]; }
  bool has_covariance() const { return covariance.size() > 0; }
  bool held_by_bound(TransformedParameter c) const;
  /// Standard error of a coordinate; empty without degrees of freedom or for an exponent at a
  /// bound.
  std::optional<double> std_error(TransformedParameter c) const;
  /// The fitted resistance curve g(w). The dead zone is not part of the curve, because it reduces
  /// the commanded force.
  Resistance<double> law() const;
};

/// Fits ln f = ln alpha + beta ln w + error by QR.                                [paper (48)-(54)]
/// Precondition: at least one point. Rank 1 if all rates are equal.
SteadyFit fit_log_linear(const std::vector<SteadyPoint>& points);

/// Fits the curve g(w), with the dead zone z, under the error model `problem.noise`:
///   log force:  ln f = ln (g(w) + z) + error
///   force:      f = g(w) + z + error
///   speed:      w = g^-1(f - z) + error
///   time:       t = travel/g^-1(f - z) + error
/// beta stays in its range; c, q and z stay >= 0. The scale of a robust loss is computed from the
/// median absolute residual. Precondition: with kTime, every point was timed.
SteadyFit fit_steady(const SteadyProblem& problem, const TransformedParameters& initial_guess);
/// Like fit_steady() above, but computes the initial guesses itself. The first guess comes from the
/// points. The other guesses are the optima of all families that are special cases of this one, so
/// that a family never fits worse than its special cases. `known`: optima of the same points, noise
/// and loss, by family; the function adds those that it computes.
SteadyFit fit_steady(const SteadyProblem& problem, std::map<Family, TransformedParameters>& known);

/// Converts a problem to the error model kTime: the time of each run becomes travel/w, with the
/// measured rate w. Empty if a run was not timed.
std::optional<SteadyProblem> by_time(SteadyProblem problem);

/// True if all parameters of the law are finite and alpha > 0.
bool is_physical(const Resistance<double>& law);

/// Residuals of a table and their derivatives with respect to coordinates of the law
/// (TransformedParameter), without the weights of a robust loss.
struct SteadyRows {
  Eigen::VectorXd residuals;  ///< one per point
  Eigen::MatrixXd jacobian;   ///< points x coordinates
};
/// Computes the residuals at the coordinates `theta`, and their derivatives with respect to the
/// coordinates in `by`. Empty if any of these numbers is not finite.
std::optional<SteadyRows> steady_rows(const SteadyProblem& problem,
                                      const TransformedParameters& theta,
                                      const std::vector<TransformedParameter>& by);

/// Bounds of one coordinate in a search; infinite if there is no bound.
Interval bounds_of(const SteadyProblem& problem, TransformedParameter c);

}  // namespace awmr
