#include "awmr/identify/main_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"

namespace awmr {
namespace {

Estimate given(double value, std::string origin) {
  return {value, {}, {}, Source::kGiven, std::move(origin)};
}

Estimate exponent_of_family(Family family) {
  return given(1.0, fmt::format("family {}", name_of(family)));
}

/// Estimate of the product factor * m': the factor is 1 for the mass m' itself, and Iz/m for the
/// yaw inertia I'z. `log_value`: ln m'. The uncertainty comes from ln m', the last number of
/// `posterior`.
Estimate from_last(const Posterior& posterior, double log_value, double factor, Source source,
                   std::string method) {
  Estimate estimate{factor * std::exp(log_value), {}, {}, source, std::move(method)};
  if (posterior.empty()) return estimate;
  const Eigen::Index last = posterior.alternatives.front().centre.size() - 1;
  set_uncertainty(
      posterior, last, *estimate.value, [&](double x) { return factor * std::exp(x); }, estimate);
  return estimate;
}

/// Relative standard deviation of the yaw inertia of a vehicle from that of a uniform box. Masses
/// near the centre make it smaller, masses at the ends larger, each by up to some 30 %, here two
/// standard deviations.
constexpr double kBoxInertiaError = 0.15;

/// The posterior with an independent error of the last number, of known standard deviation. The
/// degrees of freedom are those of the sum (Satterthwaite).
Posterior with_error(Posterior posterior, double deviation) {
  for (Posterior::Alternative& k : posterior.alternatives) {
    const Eigen::Index last = k.centre.size() - 1;
    const double before = k.covariance(last, last);
    if (!(before > 0.0) || !(deviation > 0.0)) continue;
    const double after = before + deviation * deviation;
    k.covariance(last, last) = after;
    k.dof(last) *= after * after / (before * before);
  }
  return posterior;
}

void set_beta_of_curve(const CoastFit& curve, Model& model) {
  const double error = std::sqrt(curve.beta_variance);
  const double half = t_quantile_95(curve.dof) * error;
  model[ParameterId::kSurgeBeta] = {curve.beta, error,
                                    Interval{curve.beta - half, curve.beta + half}, Source::kFitted,
                                    "coast-down curve"};
}

/// Sets the standard errors and intervals of a resistance law's parameters. They are the first
/// numbers of `posterior`. `first`: index of their block in the joint covariance.
void set_law_errors(const Subject& subject, const SteadyFit& law, const Posterior& posterior,
                    Eigen::Index first, MainValues& values) {
  for (std::size_t i = 0; i < law.free.size(); ++i) {
    const TransformedParameter c = law.free[i];
    const ParameterId id = parameter_of(subject, c);
    const double slope = jacobian_of(c, law[c]);
    set_uncertainty(
        posterior, eigen_index(i), slope, [c](double x) { return value_from(c, x); },
        values.model[id]);
    values.covariance.set(id, {{first + eigen_index(i), slope}});
  }
}

/// Sets the mass m', the yaw inertia I'z and the standard errors of the surge law. `posterior`:
/// joint distribution of the law's free parameters and of ln m'.
///   I'z = m' Iz / m                                                               [paper (68)]
void set_mass_and_law(const SteadyFit& law, double log_mass, const Posterior& posterior,
                      Source source, const std::string& method, MainValues& values) {
  Model& model = values.model;
  const Vehicle& vehicle = model.vehicle;
  model[ParameterId::kMassNorm] = from_last(posterior, log_mass, 1.0, source, method);
  const double box_error = vehicle.yaw_inertia_kgm2 ? 0.0 : kBoxInertiaError;
  model[ParameterId::kInertiaNorm] =
      from_last(with_error(posterior, box_error), log_mass,
                vehicle.inertia_kgm2() / vehicle.mass_kg, Source::kDerived,
                vehicle.yaw_inertia_kgm2 ? "m' and the given inertia" : "m' and the box formula");
  if (posterior.empty()) return;
  const Eigen::MatrixXd covariance = posterior.covariance();
  const Eigen::Index first = values.covariance.add_block(covariance);
  set_law_errors(Subject{}, law, posterior, first, values);  // Subject{}: the surge law
  const Eigen::Index last = first + covariance.rows() - 1;
  const double mass_norm = *model[ParameterId::kMassNorm].value;
  const double inertia_norm = *model[ParameterId::kInertiaNorm].value;
  values.covariance.set(ParameterId::kMassNorm, {{last, mass_norm}});
  const Eigen::Index box =
      values.covariance.add_block(Eigen::MatrixXd::Constant(1, 1, box_error * box_error));
  values.covariance.set(ParameterId::kInertiaNorm, {{last, inertia_norm}, {box, inertia_norm}});
}

void set_joint(const JointFit& joint, bool is_inadequate, MainValues& values) {
  const SteadyFit& law = joint.surge;
  Eigen::VectorXd centre(joint.covariance.rows());
  for (std::size_t i = 0; i < law.free.size(); ++i) {
    centre(eigen_index(i)) = law[law.free[i]];
    const ParameterId id = parameter_of(Subject{}, law.free[i]);
    values.model[id] = {value_from(law.free[i], law[law.free[i]]),
                        {},
                        {},
                        Source::kFitted,
                        "joint with the coast-down curves"};
  }
  centre(centre.size() - 1) = joint.log_mass_norm;
  Posterior posterior;
  if (!is_inadequate) posterior.alternatives = {{1.0, centre, joint.covariance, joint.dof}};
  set_mass_and_law(law, joint.log_mass_norm, posterior, Source::kFitted,
                   "joint with the surge runs", values);
}

/// Sets the surge family of the log fit. Terms outside this family become 0, also those of a table
/// fit.
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

Eigen::Index JointCovariance::add_block(const Eigen::MatrixXd& covariance) {
  const Eigen::Index first = size_;
  blocks_.emplace_back(first, covariance);
  size_ += covariance.rows();
  return first;
}

double JointCovariance::product(const Gradient& a, const Gradient& b) const {
  double sum = 0.0;
  for (const auto& [first, block] : blocks_) {
    for (const auto& [i, a_i] : a) {
      if (i < first || i >= first + block.rows()) continue;
      for (const auto& [j, b_j] : b) {
        if (j < first || j >= first + block.rows()) continue;
        sum += a_i * block(i - first, j - first) * b_j;
      }
    }
  }
  return sum;
}

double JointCovariance::variance(const Gradient& gradient) const {
  return product(gradient, gradient);
}

Covariance JointCovariance::covariance() const {
  Covariance covariance;
  for (const auto& [id, gradient] : gradients_) {
    covariance.parameters.push_back(id);
    std::vector<double>& row = covariance.matrix.emplace_back();
    for (const auto& [other, other_gradient] : gradients_) {
      row.push_back(0.5 * (product(gradient, other_gradient) + product(other_gradient, gradient)));
    }
  }
  return covariance;
}

void set_given(const Vehicle& vehicle, Model& model) {
  if (vehicle.sway_alpha) {
    model[ParameterId::kSwayAlpha] = given(*vehicle.sway_alpha, "vehicle");
  }
  if (vehicle.back_emf_s_per_m) {
    model[ParameterId::kBackEmf] = given(*vehicle.back_emf_s_per_m, "vehicle");
  }
  // A vehicle without steering has no servo. Its servo time constant is set to an arbitrary given
  // value, so that no fit estimates the time constant.
  constexpr double kAny_s = 1.0;
  model[ParameterId::kSteeringTimeConstant] =
      given(vehicle.has_steering() ? vehicle.steering_time_constant_s : kAny_s, "vehicle");
}

void set_law(const Subject& subject, const SubjectFit& fit, MainValues& values) {
  const SteadyFit& law = *fit.chosen;
  const Family family = fit.problem.family;
  Model& model = values.model;
  (subject.name == FitSubject::kSurge ? model.surge_family : model.yaw_family) = family;
  for (const TransformedParameter c : coordinates_of(family)) {
    model[parameter_of(subject, c)] = {value_from(c, law[c]), {}, {}, Source::kFitted, fit.method};
  }
  if (!terms_of(family).beta) model[subject.beta] = exponent_of_family(family);
  const Posterior posterior = posterior_of(fit.alternatives);
  if (posterior.empty() || fit.is_inadequate) return;
  set_law_errors(subject, law, posterior, values.covariance.add_block(posterior.covariance()),
                 values);
}

void set_mass(const MassResult& mass, const SubjectFit& surge, MainValues& values) {
  // Only for the power law: in the other families b1 has no meaning without the ratio c1/a1
  // (Coulomb) or q1/a1 (quadratic term).
  const bool power_alone = mass.alone && mass.alone->family == Family::kPower;
  if (power_alone && mass.alone->beta_variance > 0.0) set_beta_of_curve(*mass.alone, values.model);
  if (mass.joint) {
    set_joint(*mass.joint, surge.is_inadequate, values);
  } else if (mass.estimate) {
    set_mass_and_law(*surge.chosen, mass.estimate->log_mass_norm,
                     surge.is_inadequate ? Posterior{} : mass.posterior, Source::kDerived,
                     mass.estimate->method, values);
  }
  values.model.mass_norm_by_grip = mass.by_grip;
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
  if (fills(ParameterId::kMassNorm)) values.model.mass_norm_by_grip.reset();
  for (const LogStage::Main& main : logs.main) {
    values.model[main.id] = main.estimate;
    values.covariance.set(main.id, {{first + main.place, main.jacobian}});
  }
}

}  // namespace awmr
