#include "awmr/identify/planning/precision.h"

#include <algorithm>
#include <cmath>

#include "awmr/model/transform.h"

namespace awmr {
namespace {

std::optional<double> half_width_of(const Model& model, ParameterId id) {
  const Estimate& estimate = model[id];
  if (!estimate.value || !estimate.ci95 || estimate.source == Source::kGiven) return std::nullopt;
  const double half = 0.5 * (estimate.ci95->hi - estimate.ci95->lo);
  return half / std::abs(jacobian(id, *estimate.value));
}

}  // namespace

std::vector<Precision> precision_of(const Model& model, std::span<const ParameterId> requested) {
  std::vector<Precision> precisions;
  for (const ParameterInfo& parameter : parameter_table()) {
    const bool named =
        std::find(requested.begin(), requested.end(), parameter.id) != requested.end();
    const bool is_given = model[parameter.id].source == Source::kGiven;
    if ((parameter.term && !named) || !has(model.vehicle, parameter.id)) continue;
    if (requested.empty() ? is_given : !named) continue;
    precisions.push_back({parameter.id, half_width_of(model, parameter.id)});
  }
  return precisions;
}

bool is_enough(std::span<const Precision> precisions, double limit) {
  return !precisions.empty() &&
         std::all_of(precisions.begin(), precisions.end(), [limit](const Precision& one) {
           return one.half_width && *one.half_width <= limit;
         });
}

}  // namespace awmr
