#include "awmr/model/fitted_law.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "awmr/core/units.h"

namespace awmr {
namespace {

/// Derivative of the resistance law g with respect to the parameter, at the speed or yaw rate w >=
/// 0. Returns 0 if g does not depend on the parameter.
double slope_at(const Model& model, TrialKind kind, ParameterId parameter, double w) {
  const LawParameters of = law_parameters(kind);
  const double power = w > 0.0 ? std::pow(w, *model[of.beta].value) : 0.0;
  if (parameter == of.alpha) return power;
  if (parameter == of.beta) return w > 0.0 ? *model[of.alpha].value * power * std::log(w) : 0.0;
  if (parameter == of.coulomb) return 1.0;
  if (parameter == of.quadratic) return w * w;
  if (parameter == ParameterId::kWheelDeadZone && kind != TrialKind::kTurning) {
    return model.vehicle.driven_wheels();
  }
  return 0.0;
}

}  // namespace

LawParameters law_parameters(TrialKind kind) {
  if (kind == TrialKind::kTurning) {
    return {ParameterId::kYawAlpha, ParameterId::kYawBeta, ParameterId::kYawCoulomb,
            ParameterId::kYawQuadratic};
  }
  return {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta, ParameterId::kSurgeCoulomb,
          ParameterId::kSurgeQuadratic};
}

std::optional<Resistance<double>> fitted_law(const Model& model, TrialKind kind) {
  const LawParameters of = law_parameters(kind);
  if (!model[of.alpha].value || !model[of.beta].value) return std::nullopt;
  return Resistance<double>{.alpha = *model[of.alpha].value,
                            .beta = *model[of.beta].value,
                            .coulomb = *model[of.coulomb].value,
                            .quadratic = *model[of.quadratic].value};
}

double variance_of_law(const Model& model, TrialKind kind, std::span<const double> rates) {
  const std::vector<double> weights(rates.size(), 1.0 / static_cast<double>(rates.size()));
  return variance_of_law(model, kind, rates, weights);
}

double variance_of_law(const Model& model, TrialKind kind, std::span<const double> rates,
                       std::span<const double> weights) {
  const Covariance& covariance = model.covariance;
  std::vector<double> slopes;
  for (const ParameterId parameter : covariance.parameters) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rates.size(); ++i) {
      sum += weights[i] * slope_at(model, kind, parameter, rates[i]);
    }
    slopes.push_back(sum);
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    for (std::size_t j = 0; j < slopes.size(); ++j) {
      variance += slopes[i] * slopes[j] * covariance.matrix[i][j];
    }
  }
  return std::max(variance, 0.0);
}

std::optional<double> measured_yaw_rate_degps(const Model& model) {
  if (model.vehicle.yaw_rate_max_degps) return model.vehicle.yaw_rate_max_degps;
  std::optional<double> fastest;
  if (const auto& rate_radps = model.record.logged_yaw_rate_radps) fastest = degrees(*rate_radps);
  for (const TrialPoint& trial : model.record.trials) {
    if (trial.kind != TrialKind::kTurning) continue;
    fastest = std::max(fastest.value_or(0.0), degrees(trial.measured));
  }
  return fastest;
}

}  // namespace awmr
