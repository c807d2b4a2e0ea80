#include "awmr/simulate/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/model/observer_rate.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

bool is_random(const DisturbanceTerm& term) {
  return term.kind == DisturbanceTerm::Kind::kNoise ||
         (term.kind == DisturbanceTerm::Kind::kSine && !term.phase_rad);
}

bool is_random(const std::vector<DisturbanceTerm>& terms) {
  return std::any_of(terms.begin(), terms.end(),
                     [](const DisturbanceTerm& term) { return is_random(term); });
}

bool has_noise(const Channel& channel) { return channel.noise > 0.0; }

template <class... Laws>
std::vector<std::variant<Laws...>> each_of(const std::variant<Laws...>&) {
  return {Laws{}...};
}

}  // namespace

std::vector<AnyLineLaw> line_laws() { return each_of(AnyLineLaw{}); }

std::string_view name_of(const AnyLineLaw& law) {
  return std::visit([](const auto& held) { return std::string_view(held.name()); }, law);
}

std::vector<std::string> line_law_names() {
  std::vector<std::string> names;
  for (const AnyLineLaw& law : line_laws()) names.emplace_back(name_of(law));
  return names;
}

std::optional<double> Scenario::held_tau_speed() const {
  const auto* heading = std::get_if<HeadingSteps>(&guidance);
  return heading ? heading->tau_speed : std::nullopt;
}

bool Scenario::random() const {
  if (is_random(disturbance.surge) || is_random(disturbance.sway) || is_random(disturbance.yaw)) {
    return true;
  }
  return sensors && (has_noise(sensors->heading) || has_noise(sensors->yaw_rate) ||
                     has_noise(sensors->speed) || (sensors->gps && has_noise(sensors->gps->x)));
}

Scenario heading_steps(const std::vector<double>& headings_deg,
                       const HeadingStepsOptions& options) {
  HeadingSteps guidance;
  for (std::size_t i = 0; i < headings_deg.size(); ++i) {
    guidance.steps.push_back({static_cast<double>(i) * options.hold_s, radians(headings_deg[i])});
  }
  return {.name = options.name,
          .duration_s = static_cast<double>(headings_deg.size()) * options.hold_s,
          .initial = {},
          .speed_mps = options.speed_mps,
          .guidance = std::move(guidance)};
}

std::span<const YawMode> yaw_modes(const Vehicle& vehicle) {
  const std::span<const YawMode> all(kYawModes);
  return vehicle.has_steering() ? all : all.first(1);
}

Status check_mode(const Vehicle& vehicle, YawMode mode) {
  const auto modes = yaw_modes(vehicle);
  if (std::find(modes.begin(), modes.end(), mode) != modes.end()) return {};
  return input_error(
      ErrorCode::kUnsupported, option_text("mode"),
      fmt::format("a vehicle with drive \"{}\" has no steering, but mode {} needs it; give mode {}",
                  name_in(kDriveNames, vehicle.drive), name_of(mode), name_of(modes.front())));
}

std::vector<TyreConflict> tyre_conflicts(const Scenario& scenario) {
  std::vector<TyreConflict> conflicts;
  if (!scenario.patches.empty()) {
    conflicts.push_back(
        {"slippery",
         "a patch limits only the longitudinal forces of the wheels, but with tyres, "
         "wheels also make lateral forces; remove slippery or tyres"});
  }
  for (const CornerParameter& corner : scenario.corner) {
    switch (corner.id) {
      case ParameterId::kSwayAlpha:
      case ParameterId::kYawAlpha:
      case ParameterId::kYawBeta:
      case ParameterId::kYawCoulomb:
      case ParameterId::kYawQuadratic:
        conflicts.push_back(
            {"corner", std::string(info(corner.id).name) +
                           " has no effect on tyres, because their forces replace this "
                           "resistance; remove it from corner, or remove tyres"});
        break;
      default:
        break;
    }
  }
  return conflicts;
}

std::string plant_text(const Scenario& scenario) {
  if (!scenario.tyres) return std::string(name_in(kPlantKindNames, PlantKind::kModel));
  const Tyres<double>& tyres = *scenario.tyres;
  return fmt::format("{}, friction {}, cornering stiffness {} per rad, rest speed {} m/s",
                     name_in(kPlantKindNames, PlantKind::kFourWheel), tyres.friction,
                     tyres.cornering_per_rad, tyres.rest_speed_mps);
}

Result<Model> model_at_corner(Model model, const Scenario& scenario) {
  std::vector<Fault> faults;
  for (const CornerParameter& corner : scenario.corner) {
    Estimate& estimate = model[corner.id];
    if (!estimate.ci95) {
      faults.push_back(
          {ErrorCode::kNotIdentified, model.file + ":" + std::string(info(corner.id).pointer),
           "has no 95 % interval (ci95), but the corner of scenario '" + scenario.name +
               "' sets this parameter to an end of its interval; identify it from "
               "trials, or remove it from the corner"});
      continue;
    }
    estimate.value = corner.high ? estimate.ci95->hi : estimate.ci95->lo;
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return model;
}

Status check_tyres(const Scenario& scenario) {
  std::vector<Fault> faults;
  if (scenario.tyres) {
    for (const TyreConflict& conflict : tyre_conflicts(scenario)) {
      faults.push_back({ErrorCode::kConflict,
                        fmt::format("scenario '{}':/{}", scenario.name, conflict.key),
                        conflict.message});
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

/// Checks the LQI heading law, if the scenario has one. Errors (input): with its gains, the heading
/// loop is unstable at the sample time.
Status check_lqi(const Scenario& scenario, const Model& model) {
  const auto& inertia_norm = model[ParameterId::kInertiaNorm].value;
  if (!scenario.control.lqi || !inertia_norm) return {};
  const double sample_time_s = model.vehicle.sample_time_s;
  const LqiGains<double> gains = lqi_gains(*scenario.control.lqi, *inertia_norm);
  if (settles_when_sampled(gains, sample_time_s)) return {};
  return input_error(
      ErrorCode::kDiverges, fmt::format("scenario '{}':/control/heading_law", scenario.name),
      fmt::format(
          "these LQI weights give a gain of {:.3g} 1/s on the yaw rate, with which the heading "
          "loop is unstable at sample_time_s {:g}; give a smaller tau_turn_m, or larger "
          "heading_deg, yaw_rate_degps and integral_deg_s",
          gains.rate_per_s, sample_time_s));
}

Status check_observer(const Scenario& scenario, const Model& model) {
  if (!scenario.control.observer) return {};
  return check_observer_rate(
      scenario.control.observer->bandwidth_radps, model.vehicle.sample_time_s,
      fmt::format("scenario '{}':/control/disturbance_observer/bandwidth_radps", scenario.name));
}

/// Checks the motor faults. Errors (input): none of the wheels of a fault has a motor.
Status check_faults(const Scenario& scenario, const Model& model) {
  if (model.vehicle.drive != Drive::kFrontWheel) return {};
  std::vector<Fault> errors;
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const auto is_driven = [](Wheel wheel) {
      return wheel == Wheel::kFrontLeft || wheel == Wheel::kFrontRight;
    };
    const std::vector<Wheel>& wheels = scenario.faults[i].wheels;
    if (std::any_of(wheels.begin(), wheels.end(), is_driven)) continue;
    errors.push_back({ErrorCode::kConflict,
                      fmt::format("scenario '{}':/faults/{}/wheel", scenario.name, i),
                      fmt::format("this wheel has no motor that could fail, because the drive of "
                                  "the vehicle is \"{}\"; name a front wheel, or remove the fault",
                                  name_in(kDriveNames, model.vehicle.drive))});
  }
  if (!errors.empty()) return input_errors(std::move(errors));
  return {};
}

Status check_scenario(const Scenario& scenario, const Model& model) {
  AWMR_RETURN_IF_ERROR(check_tyres(scenario));
  AWMR_RETURN_IF_ERROR(check_faults(scenario, model));
  AWMR_RETURN_IF_ERROR(check_lqi(scenario, model));
  return check_observer(scenario, model);
}

Result<Plant<double>> plant_for(const Scenario& scenario, const Model& model, Motion motion) {
  AWMR_RETURN_IF_ERROR(check_scenario(scenario, model));
  AWMR_ASSIGN_OR_RETURN(const Model corner, model_at_corner(model, scenario));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, corner.plant(motion));
  AWMR_RETURN_IF_ERROR(check_work(plant, model.file, scenario, model.vehicle.sample_time_s));
  return plant;
}

}  // namespace awmr
