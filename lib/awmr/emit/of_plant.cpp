#include "of_plant.h"

#include <algorithm>
#include <cmath>

#include "awmr/model/plant_of.h"

namespace awmr {
namespace {

ParameterValues<double> values_of(const Model& model) {
  ParameterValues<double> values{};
  for (const ParameterInfo& parameter : parameter_table()) {
    values[static_cast<std::size_t>(parameter.id)] = model[parameter.id].value.value_or(1.0);
  }
  return values;
}

/// Returns df/dp, the derivative of the number f with respect to the parameter p with this id, by a
/// central difference; 0 if the parameter is 0.
double sensitivity(const Model& model, ParameterId id, const OfPlant& f) {
  const auto at = [&](double factor) {
    ParameterValues<double> values = values_of(model);
    values[static_cast<std::size_t>(id)] *= factor;
    return f(plant_of(model.vehicle, values));
  };
  constexpr double kStep = 1e-5;
  const double value = *model[id].value;
  return value == 0.0 ? 0.0 : (at(1.0 + kStep) - at(1.0 - kStep)) / (2.0 * kStep * value);
}

}  // namespace

std::optional<double> std_error_of(const Model& model, const OfPlant& f) {
  const std::vector<ParameterId>& ids = model.covariance.parameters;
  std::vector<double> gradient(ids.size());
  for (const ParameterInfo& parameter : parameter_table()) {
    const Estimate& estimate = model[parameter.id];
    if (!estimate.value || estimate.source == Source::kGiven) continue;
    const double g = sensitivity(model, parameter.id, f);
    const auto place = std::find(ids.begin(), ids.end(), parameter.id);
    if (place != ids.end()) gradient[static_cast<std::size_t>(place - ids.begin())] = g;
    if (place == ids.end() && g != 0.0) return std::nullopt;
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t j = 0; j < ids.size(); ++j) {
      variance += gradient[i] * gradient[j] * model.covariance.matrix[i][j];
    }
  }
  if (!(variance > 0.0) || !std::isfinite(variance)) return std::nullopt;
  return std::sqrt(variance);
}

}  // namespace awmr
