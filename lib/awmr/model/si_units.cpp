#include "awmr/model/si_units.h"

#include <algorithm>
#include <cmath>

#include "awmr/model/transform.h"

namespace awmr {
namespace {

/// Below this fraction of its positive terms, the variance of a quantity Q in SI units counts as 0:
/// it is only rounding, because Q does not depend on m' and the terms cancel.
constexpr double kRounding = 1e-14;

/// True for parameters that are divided by F_max in the equations of motion: all except exponents
/// and the servo's time constant.
bool is_over_max_force(ParameterId id) {
  return id != ParameterId::kSurgeBeta && id != ParameterId::kYawBeta &&
         id != ParameterId::kSteeringTimeConstant;
}

/// Covariance of the parameters a and b. 0 if one of them is a given value, which is exact; none if
/// the model's covariance does not contain both.
std::optional<double> covariance_of(const Model& model, ParameterId a, ParameterId b) {
  if (model[a].source == Source::kGiven || model[b].source == Source::kGiven) return 0.0;
  const std::vector<ParameterId>& ids = model.covariance.parameters;
  const auto row = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), a) - ids.begin());
  const auto column = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), b) - ids.begin());
  if (row == ids.size() || column == ids.size()) return std::nullopt;
  return model.covariance.matrix[row][column];
}

/// Half width of a parameter's 95 % interval divided by its standard error, both in the parameter's
/// coordinate (transform.h). 0 for a given value, which is exact; none without an interval.
std::optional<double> quantile_of(const Model& model, ParameterId id) {
  const Estimate& estimate = model[id];
  if (estimate.source == Source::kGiven) return 0.0;
  if (!estimate.std_error || !(*estimate.std_error > 0.0) || !estimate.ci95) return std::nullopt;
  const double half =
      0.5 * (to_coordinate(id, estimate.ci95->hi) - to_coordinate(id, estimate.ci95->lo));
  return half * jacobian(id, *estimate.value) / *estimate.std_error;
}

/// Q = p m/m', the parameter p in SI units, with its uncertainty (si_units.h).
Estimate times_max_force(const Model& model, ParameterId id) {
  const double p = *model[id].value;
  const double mass_norm = *model[ParameterId::kMassNorm].value;
  const double force_n = max_wheel_force_n(model.vehicle.mass_kg, mass_norm);
  Estimate q{p * force_n, {}, {}, Source::kDerived, "times m/m'"};
  const auto c_pp = covariance_of(model, id, id);
  const auto c_pm = covariance_of(model, id, ParameterId::kMassNorm);
  const auto c_mm = covariance_of(model, ParameterId::kMassNorm, ParameterId::kMassNorm);
  if (!c_pp || !c_pm || !c_mm) return q;
  const double ratio = p / mass_norm;
  const double of_both = *c_pp + ratio * ratio * *c_mm;
  const double variance = force_n * force_n * (of_both - 2.0 * ratio * *c_pm);
  if (!(variance > kRounding * force_n * force_n * of_both)) return q;
  q.std_error = std::sqrt(variance);
  const auto k_p = quantile_of(model, id);
  const auto k_m = quantile_of(model, ParameterId::kMassNorm);
  if (!k_p || !k_m) return q;
  const double centre = to_coordinate(id, *q.value);
  const double half = std::max(*k_p, *k_m) * *q.std_error / jacobian(id, *q.value);
  const Interval ci95{from_coordinate(id, centre - half), from_coordinate(id, centre + half)};
  if (std::isfinite(ci95.lo) && std::isfinite(ci95.hi)) q.ci95 = ci95;
  return q;
}

/// F_max = m/m'. Its interval follows from the ends of the interval of m'.
Estimate max_force(const Model& model) {
  const Estimate& mass = model[ParameterId::kMassNorm];
  const double mass_kg = model.vehicle.mass_kg;
  Estimate force{max_wheel_force_n(mass_kg, *mass.value), {}, {}, Source::kDerived, "m/m'"};
  if (mass.std_error) force.std_error = *force.value * *mass.std_error / *mass.value;
  if (mass.ci95 && mass.ci95->lo > 0.0) {
    force.ci95 = Interval{max_wheel_force_n(mass_kg, mass.ci95->hi),
                          max_wheel_force_n(mass_kg, mass.ci95->lo)};
  }
  return force;
}

/// Converts a parameter that is divided by F_max to SI units, by multiplication with F_max. For
/// example, I'z in s^2 m times N is kg m^2.
SiQuantity quantity_of(const Model& model, const ParameterInfo& parameter) {
  if (parameter.id == ParameterId::kInertiaNorm) {
    return {"/yaw_inertia", "Iz", "kg m^2", times_max_force(model, parameter.id)};
  }
  return {std::string(parameter.pointer), std::string(parameter.name),
          parameter.unit == "1" ? "N" : "N " + std::string(parameter.unit),
          times_max_force(model, parameter.id)};
}

}  // namespace

std::vector<SiQuantity> si_quantities(const Model& model) {
  if (!model[ParameterId::kMassNorm].value) return {};
  std::vector<SiQuantity> quantities{
      {"/max_wheel_force", "F_max", "N", max_force(model)},
      {"/mass", "m", "kg", {model.vehicle.mass_kg, {}, {}, Source::kGiven, "vehicle"}}};
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    if (!estimate.value || !is_over_max_force(parameter.id)) continue;
    if (parameter.id == ParameterId::kMassNorm) continue;  // m itself
    if (is_absent_term(model, parameter.id)) continue;
    quantities.push_back(quantity_of(model, parameter));
  }
  return quantities;
}

}  // namespace awmr
