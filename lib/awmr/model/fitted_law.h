/// The resistance law that a model's trials show, and what they leave open of it.
#pragma once

#include <optional>
#include <span>

#include "awmr/model/model.h"

namespace awmr {

/// A law that was fitted up to some rate holds a little further; beyond this many times it, it is
/// extrapolated.
inline constexpr double kLittleFurther = 1.2;

/// Which of a model's parameters are a law's:
///   g(w) = c + alpha w^beta + q w^2
struct LawParameters {
  ParameterId alpha, beta, coulomb, quadratic;
};
/// g3 of turning, g1 of the other kinds.
LawParameters law_parameters(TrialKind kind);

/// The law with the model's values, without the wheels' dead zone; absent where alpha or beta has none.
std::optional<Resistance<double>> fitted_law(const Model& model, TrialKind kind);

/// Of sum_i weight_i g(w_i) over rates w_i >= 0, g being the moment or the force that a run at such a rate takes:
///   h' C h,  h = sum_i weight_i (dg/dalpha, dg/dbeta, dg/dc, dg/dq, dg/dF'0)
///              = sum_i weight_i (w^beta, alpha w^beta ln w, 1, w^2, z)
/// C is the covariance as far as the model has it; z the driven wheels, whose dead zones F'0 a straight
/// run overcomes; 0 in a turn, whose moments are told beyond them. >= 0, in the square of g's unit times a
/// weight's. Precondition: the law is fitted; as many weights as rates.
double variance_of_law(const Model& model, TrialKind kind, std::span<const double> rates,
                       std::span<const double> weights);

/// Of their mean.
double variance_of_law(const Model& model, TrialKind kind, std::span<const double> rates);

/// The fastest turn, deg/s, up to which yaw resistance was measured: the vehicle's
/// yaw_rate_max_degps, else the fastest turning trial of the record, in tables or logs. Absent where
/// neither says.
std::optional<double> measured_yaw_rate_degps(const Model& model);

}  // namespace awmr
