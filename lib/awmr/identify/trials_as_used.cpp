#include "awmr/identify/trials_as_used.h"

#include <optional>
#include <string>

#include "awmr/identify/tables/subject.h"
#include "awmr/model/fitted_law.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

std::optional<double> predicted(const Model& model, TrialKind kind, double input) {
  const auto surge = fitted_law(model, TrialKind::kSurge);
  const auto yaw = fitted_law(model, TrialKind::kTurning);
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
