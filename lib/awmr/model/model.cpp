#include "awmr/model/model.h"

#include <fmt/format.h>

#include <algorithm>

#include "awmr/model/plant_of.h"

namespace awmr {
namespace {

/// Number by which Model::plant_as_known() replaces a missing value.
double none_of(ParameterId id) {
  switch (id) {
    case ParameterId::kSurgeBeta:
    case ParameterId::kYawBeta:
    case ParameterId::kMassNorm:
    case ParameterId::kInertiaNorm:
    case ParameterId::kSteeringTimeConstant:
      return 1.0;
    default:
      return 0.0;
  }
}

/// The model's plant. Errors (input): a parameter for which is_needed(id) is true has no value.
template <class IsNeeded>
Result<Plant<double>> plant_with(const Model& model, IsNeeded is_needed) {
  std::vector<Fault> faults;
  for (const ParameterInfo& parameter : parameter_table()) {
    if (model[parameter.id].value || !is_needed(parameter.id)) continue;
    if (!has(model.vehicle, parameter.id)) continue;
    faults.push_back(
        {ErrorCode::kNotIdentified, fmt::format("{}:{}", model.file, parameter.pointer),
         fmt::format(
             "no value for {} ({}, {}), on which the motion depends; identify again with {}",
             parameter.name, parameter.symbol, parameter.meaning,
             trial_of(model.vehicle, parameter.id))});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return model.plant_as_known();
}

Motion motion_of(TrialKind kind) {
  switch (kind) {
    case TrialKind::kSurge:
      return Motion::kSteadySurge;
    case TrialKind::kTurning:
      return Motion::kSteadyTurn;
    case TrialKind::kCoastdown:
      return Motion::kStraight;
    case TrialKind::kLog:
      break;
  }
  return Motion::kPlanar;
}

}  // namespace

bool is_absent_term(const Model& model, ParameterId id) {
  return info(id).term && model[id].source == Source::kGiven && model[id].value == 0.0;
}

double max_wheel_force_n(double mass_kg, double mass_norm) { return mass_kg / mass_norm; }

Model::Model() {
  for (const ParameterInfo& parameter : parameter_table()) {
    if (parameter.term) (*this)[parameter.id] = {0.0, {}, {}, Source::kGiven, "not in the family"};
  }
}

bool has(const Vehicle& vehicle, ParameterId id) {
  return vehicle.has_steering() || id != ParameterId::kSteeringTimeConstant;
}

std::string_view trial_of(const Vehicle& vehicle, ParameterId id) {
  const bool turning = takes(Motion::kSteadyTurn, id) && !takes(Motion::kSteadySurge, id);
  if (!turning || vehicle.has_steering()) return info(id).trial;
  return "a turning trial: runs at two or more constant differences of force_right and force_left, "
         "each with its steady yaw rate";
}

bool takes(Motion motion, ParameterId id) {
  switch (id) {
    case ParameterId::kSurgeAlpha:
    case ParameterId::kSurgeBeta:
    case ParameterId::kSurgeCoulomb:
    case ParameterId::kSurgeQuadratic:
      return motion != Motion::kSteadyTurn;
    case ParameterId::kYawAlpha:
    case ParameterId::kYawBeta:
    case ParameterId::kYawCoulomb:
    case ParameterId::kYawQuadratic:
      return motion == Motion::kSteadyTurn || motion == Motion::kPlanar;
    case ParameterId::kWheelDeadZone:
    case ParameterId::kBackEmf:
      return true;
    case ParameterId::kMassNorm:
      return motion == Motion::kStraight || motion == Motion::kPlanar;
    case ParameterId::kSwayAlpha:
    case ParameterId::kInertiaNorm:
    case ParameterId::kSteeringTimeConstant:
      break;
  }
  return motion == Motion::kPlanar;
}

Result<Plant<double>> Model::plant(Motion motion) const {
  return plant_with(*this, [motion](ParameterId id) { return takes(motion, id); });
}

Result<Plant<double>> Model::plant_of_trials() const {
  return plant_with(*this, [this](ParameterId id) {
    return std::any_of(record.trials.begin(), record.trials.end(),
                       [id](const TrialPoint& trial) { return takes(motion_of(trial.kind), id); });
  });
}

Plant<double> Model::plant_as_known() const {
  ParameterValues<double> values{};
  for (const ParameterInfo& parameter : parameter_table()) {
    values[static_cast<std::size_t>(parameter.id)] =
        (*this)[parameter.id].value.value_or(none_of(parameter.id));
  }
  Plant<double> plant = plant_of(vehicle, values);
  // Tyre scrub always resists a turn, so a negative estimate of its moment is noise and counts as
  // 0.
  if (yaw_scrub) plant.yaw_scrub_m = std::max(yaw_scrub->moment_m, 0.0);
  return plant;
}

Motion Model::simulated_motion() const { return plant() ? Motion::kPlanar : Motion::kStraight; }

}  // namespace awmr
