#include "awmr/identify/main_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/uncertainty/quantiles.h"

namespace awmr {
namespace {

Estimate given(double value, std::string origin) {
  return {value, {}, {}, Source::kGiven, std::move(origin)};
}

Estimate exponent_of_family(Family family) {
  return given(1.0, fmt::format("family {}", name_of(family)));
}

/// exp(value) with the standard error of its logarithm, the interval symmetric in the logarithm.
Estimate from_log(double log_value, std::optional<double> variance, double degrees_of_freedom,
                  Source source, std::string method) {
  Estimate estimate{std::exp(log_value), {}, {}, source, std::move(method)};
  if (variance) {
    const double error = std::sqrt(*variance);
    const double half = t_quantile_95(degrees_of_freedom) * error;
    estimate.std_error = *estimate.value * error;
    estimate.ci95 = Interval{std::exp(log_value - half), std::exp(log_value + half)};
  }
  return estimate;
}

void set_beta_of_curve(const CoastFit& curve, Model& model) {
  const double error = std::sqrt(curve.beta_variance);
  const double half = t_quantile_95(curve.dof) * error;
  model[ParameterId::kSurgeBeta] = {curve.beta, error,
                                    Interval{curve.beta - half, curve.beta + half}, Source::kFitted,
                                    "coast-down curve"};
}

/// I'z = m' Iz / m                                                                 [paper (68)]
void set_inertia(double log_mass, std::optional<double> variance, double dof, Model& model) {
  const Vehicle& vehicle = model.vehicle;
  model[ParameterId::kInertiaNorm] =
      from_log(log_mass + std::log(vehicle.inertia_kgm2() / vehicle.mass_kg), variance, dof,
               Source::kDerived,
               vehicle.yaw_inertia_kgm2 ? "m' and the given inertia" : "m' and the box formula");
}

/// m' and I'z are the same function of the surge law and the coast-down, but for a factor.
void set_mass_estimate(const MassEstimate& mass, const SteadyFit& surge, MainValues& values) {
  Model& model = values.model;
  const auto variance = mass.variance(surge);
  const double dof = variance ? mass.dof(surge) : 0.0;
  model[ParameterId::kMassNorm] =
      from_log(mass.log_mass_norm, variance, dof, Source::kDerived, mass.method);
  set_inertia(mass.log_mass_norm, variance, dof, model);
  if (!variance) return;
  const Eigen::Index own =
      values.covariance.add_block(Eigen::MatrixXd::Constant(1, 1, mass.own_variance));
  for (const ParameterId id : {ParameterId::kMassNorm, ParameterId::kInertiaNorm}) {
    const double value = *model[id].value;
    JointCovariance::Gradient gradient{{own, value}};
    for (Eigen::Index i = 0; i < mass.by_surge.size(); ++i) {
      gradient[*values.surge_block + i] = value * mass.by_surge(i);
    }
    values.covariance.set(id, std::move(gradient));
  }
}

void set_joint(const JointFit& joint, MainValues& values) {
  Model& model = values.model;
  const Eigen::Index first = values.covariance.add_block(joint.covariance);
  const Subject surge{};  // the ids of surge
  for (std::size_t i = 0; i < joint.surge.free.size(); ++i) {
    const Eigen::Index row = eigen_index(i);
    const TransformedParameter c = joint.surge.free[i];
    const double x = joint.surge[c];
    const double error = std::sqrt(joint.covariance(row, row));
    const double half = t_quantile_95(joint.dof(row)) * error;
    model[parameter_of(surge, c)] = {value_from(c, x), jacobian_of(c, x) * error,
                                     values_from(c, {x - half, x + half}), Source::kFitted,
                                     "joint with the coast-down curves"};
    values.covariance.set(parameter_of(surge, c), {{first + row, jacobian_of(c, x)}});
  }
  const Eigen::Index last = joint.covariance.rows() - 1;
  const double variance = joint.covariance(last, last);
  model[ParameterId::kMassNorm] = from_log(joint.log_mass_norm, variance, joint.dof(last),
                                           Source::kFitted, "joint with the surge runs");
  set_inertia(joint.log_mass_norm, variance, joint.dof(last), model);
  for (const ParameterId id : {ParameterId::kMassNorm, ParameterId::kInertiaNorm}) {
    values.covariance.set(id, {{first + last, *model[id].value}});
  }
}

/// Terms that the logs' families do not have are gone, whatever the tables' had.
void set_surge_family_of_logs(Family surge, Model& model) {
  model.surge_family = surge;
  const Estimate none = given(0.0, "not in the family");
  const FamilyTerms terms = terms_of(surge);
  if (!terms.coulomb) model[ParameterId::kSurgeCoulomb] = none;
  if (!terms.quadratic) model[ParameterId::kSurgeQuadratic] = none;
  if (!terms.dead_zone) model[ParameterId::kWheelDeadZone] = none;
  if (!terms.beta) model[ParameterId::kSurgeBeta] = exponent_of_family(surge);
}

void set_yaw_family_of_logs(Family yaw, Model& model) {
  model.yaw_family = yaw;
  const Estimate none = given(0.0, "not in the family");
  const FamilyTerms terms = terms_of(yaw);
  if (!terms.coulomb) model[ParameterId::kYawCoulomb] = none;
  if (!terms.quadratic) model[ParameterId::kYawQuadratic] = none;
  if (!terms.beta) model[ParameterId::kYawBeta] = exponent_of_family(yaw);
}

}  // namespace

void set_given(const Vehicle& vehicle, Model& model) {
  if (vehicle.sway_alpha) {
    model[ParameterId::kSwayAlpha] = given(*vehicle.sway_alpha, "vehicle");
  }
  if (vehicle.back_emf_s_per_m) {
    model[ParameterId::kBackEmf] = given(*vehicle.back_emf_s_per_m, "vehicle");
  }
  // Wheels that stay straight have no lag. It is held at any value until the fits are done, so that
  // none of them looks for it.
  constexpr double kAny_s = 1.0;
  model[ParameterId::kSteeringTimeConstant] =
      given(vehicle.has_steering() ? vehicle.steering_time_constant_s : kAny_s, "vehicle");
}

void set_law(const Subject& subject, const SubjectFit& fit, MainValues& values) {
  const SteadyFit& law = *fit.chosen;
  const Family family = fit.problem.family;
  Model& model = values.model;
  const bool surge = subject.name == FitSubject::kSurge;
  (surge ? model.surge_family : model.yaw_family) = family;
  for (const TransformedParameter c : coordinates_of(family)) {
    model[parameter_of(subject, c)] = estimate_of(law, c, {}, fit.method);
  }
  if (!terms_of(family).beta) model[subject.beta] = exponent_of_family(family);
  if (!law.has_covariance()) return;
  const Eigen::Index first = values.covariance.add_block(law.covariance);
  for (std::size_t i = 0; i < law.free.size(); ++i) {
    const TransformedParameter c = law.free[i];
    values.covariance.set(parameter_of(subject, c),
                          {{first + eigen_index(i), jacobian_of(c, law[c])}});
  }
  if (surge) values.surge_block = first;
}

void set_mass(const MassResult& mass, const std::optional<SteadyFit>& surge, MainValues& values) {
  // Of another family than the power law, an exponent alone is no law.
  const bool power_alone = mass.alone && mass.alone->family == Family::kPower;
  if (power_alone && mass.alone->beta_variance > 0.0) set_beta_of_curve(*mass.alone, values.model);
  if (mass.joint) {
    set_joint(*mass.joint, values);
  } else if (mass.estimate) {
    set_mass_estimate(*mass.estimate, *surge, values);
  }
}

void set_logs(const LogStage& logs, MainValues& values) {
  if (logs.block.size() == 0) return;
  if (logs.is_back_emf_open) values.model[ParameterId::kBackEmf] = {};
  const Eigen::Index first = values.covariance.add_block(logs.block);
  const auto fills = [&](ParameterId id) {
    return std::ranges::any_of(logs.main,
                               [&](const LogStage::Main& main) { return main.id == id; });
  };
  if (fills(ParameterId::kSurgeAlpha)) set_surge_family_of_logs(logs.surge_family, values.model);
  if (fills(ParameterId::kYawAlpha)) set_yaw_family_of_logs(logs.yaw_family, values.model);
  for (const LogStage::Main& main : logs.main) {
    values.model[main.id] = main.estimate;
    values.covariance.set(main.id, {{first + main.place, main.jacobian}});
  }
}

}  // namespace awmr
