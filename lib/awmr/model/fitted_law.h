/// The resistance law identified from a model's trials, and its uncertainty.
#pragma once

#include <optional>
#include <span>

#include "awmr/model/model.h"

namespace awmr {

/// At speeds (or yaw rates) above the largest fitted one times this factor, or below the smallest
/// one divided by it, a resistance law counts as far extrapolated. The factor is a choice: with a
/// larger one, warnings come later.
inline constexpr double kLittleFurther = 1.2;

/// The model parameters that are the coefficients of a resistance law:
///   g(w) = c + alpha w^beta + q w^2
struct LawParameters {
  ParameterId alpha, beta, coulomb, quadratic;
};
/// The coefficients of g3 for turning trials, those of g1 for the other kinds of trial.
LawParameters law_parameters(TrialKind kind);

/// The resistance law (g3 for turning trials, else g1) with the model's values. It does not include
/// the dead zone of the wheels. Absent if alpha or beta has no value.
std::optional<Resistance<double>> fitted_law(const Model& model, TrialKind kind);

/// Variance of the weighted sum of weight_i g(w_i) that follows from the covariance of the
/// parameters. `rates` are the speeds or yaw rates w_i >= 0. g(w) is the force or moment with which
/// a run stays at the steady speed w. Variance:
///   h' C h,  h = sum_i weight_i (dg/dalpha, dg/dbeta, dg/dc, dg/dq, dg/dF'0)
///              = sum_i weight_i (w^beta, alpha w^beta ln w, 1, w^2, z)
/// C is the model's covariance; parameters that it does not contain count as exact. A straight run
/// must overcome the dead zones F'0 of all driven wheels, so z is the number of driven wheels. For
/// turns, z = 0, because their moments already exclude the dead zone. The result is >= 0, in the
/// squared unit of g times that of a weight. Precondition: the law is fitted; as many weights as
/// rates.
double variance_of_law(const Model& model, TrialKind kind, std::span<const double> rates,
                       std::span<const double> weights);

/// Variance of the mean of g(w_i) over the speeds or yaw rates w_i in `rates`: variance_of_law()
/// above with equal weights.
double variance_of_law(const Model& model, TrialKind kind, std::span<const double> rates);

/// The largest yaw rate, deg/s, for which the yaw resistance was measured: the vehicle's
/// yaw_rate_max_degps, else the largest yaw rate of the turning trials and logs in the record.
/// Absent if there is none.
std::optional<double> measured_yaw_rate_degps(const Model& model);

}  // namespace awmr
