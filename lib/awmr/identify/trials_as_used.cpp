#include "awmr/identify/trials_as_used.h"

#include <optional>
#include <string>

#include "awmr/identify/tables/subject.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

/// None where alpha or beta is not known.
std::optional<Resistance<double>> law_of(const Model& model, ParameterId alpha, ParameterId beta,
                                         ParameterId coulomb, ParameterId quadratic) {
  if (!model[alpha].value || !model[beta].value) return std::nullopt;
  return Resistance<double>{.alpha = *model[alpha].value,
                            .beta = *model[beta].value,
                            .coulomb = *model[coulomb].value,
                            .quadratic = *model[quadratic].value};
}

/// u or r by the law that is in the model, and the stop time.
std::optional<double> predicted(const Model& model, TrialKind kind, double input) {
  const auto surge = law_of(model, ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta,
                            ParameterId::kSurgeCoulomb, ParameterId::kSurgeQuadratic);
  const auto yaw = law_of(model, ParameterId::kYawAlpha, ParameterId::kYawBeta,
                          ParameterId::kYawCoulomb, ParameterId::kYawQuadratic);
  if (kind == TrialKind::kSurge && surge) {
    const double zone = *model[ParameterId::kWheelDeadZone].value;
    return steady_rate(*surge, input - model.vehicle.driven_wheels() * zone);
  }
  if (kind == TrialKind::kTurning && yaw) return steady_rate(*yaw, input);
  if (kind == TrialKind::kCoastdown && surge && model[ParameterId::kMassNorm].value) {
    return stop_time_s(*surge, *model[ParameterId::kMassNorm].value, input);
  }
  return std::nullopt;
}

}  // namespace

std::vector<TrialPoint> trials_as_used(const TrialData& data, const Model& model) {
  std::vector<TrialPoint> trials;
  const auto keep = [&](TrialKind kind, const std::string& file, int line, double input,
                        double measured) {
    trials.push_back({kind, file, line, input, measured, predicted(model, kind, input)});
  };
  if (data.surge) {
    for (const SurgeRow& row : data.surge->rows) {
      keep(TrialKind::kSurge, data.surge->file, row.line, row.tau_speed, row.speed_mps);
    }
  }
  if (data.turning) {
    const double dead_zone = *model[ParameterId::kWheelDeadZone].value;
    for (const SteadyPoint& point : turning_points(data.turning->rows, dead_zone)) {
      keep(TrialKind::kTurning, data.turning->file, point.line, point.force, point.rate);
    }
  }
  if (data.coastdown) {
    for (const StopTimeRow& row : data.coastdown->rows) {
      keep(TrialKind::kCoastdown, data.coastdown->file, row.line, row.initial_speed_mps,
           row.stop_time_s);
    }
  }
  return trials;
}

}  // namespace awmr
