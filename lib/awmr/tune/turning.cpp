#include "awmr/tune/turning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

/// Largest steering angle that a message proposes, deg.
constexpr double kLargestAngle_deg = 60.0;

/// Returns changes, as text: a larger steering stop, or a higher speed. Each change alone lets the
/// steering make `moment_m`.
std::vector<std::string> steering_changes(const DrawnVehicle& vehicle, double speed_mps,
                                          double moment_m) {
  const Plant<double>& plant = vehicle.plant;
  const double factor = steering_angle_factor(plant);
  std::vector<std::string> changes;
  const double per_angle_m = plant.front_axle_m * plant.surge(speed_mps);
  const double angle_deg = degrees(std::atan(moment_m / per_angle_m)) / factor;
  if (angle_deg <= kLargestAngle_deg) {
    changes.push_back(fmt::format("a steering stop (`max_deg`) above {:.3g} deg", angle_deg));
  }
  const double thrust = moment_m / (plant.front_axle_m * std::tan(factor * plant.steering_max_rad));
  const double wheels = driven_wheels(plant);
  const auto faster = steady_rate(plant.surge, thrust);
  if (faster &&
      thrust <= wheels * (forces_beyond_dead_zone(vehicle).hi - plant.back_emf_s_per_m * *faster)) {
    changes.push_back(fmt::format("a speed above {:.3g} m/s", *faster));
  }
  return changes;
}

/// Returns changes, as text. Each change alone lets the mode turn the vehicle.
std::vector<std::string> changes(const TurningMoment& moment, const DrawnVehicle& vehicle) {
  const Plant<double>& plant = vehicle.plant;
  std::vector<std::string> found;
  if (moment.mode != YawMode::kDifferential) {
    found = steering_changes(vehicle, moment.speed_mps, moment.needed_m);
  }
  const double span = 2.0 * moment.needed_m / (driven_wheels(plant) * plant.half_track_m) +
                      2.0 * plant.wheel_dead_zone;
  constexpr double kWidest = 2.0;  // F' from -1 to 1
  if (moment.mode != YawMode::kSteering && span <= kWidest) {
    found.push_back(fmt::format("a `wheel_force` range wider than {:.3g}", span));
  }
  return found;
}

/// True if the vehicle can turn while it accelerates: the scenario starts below its commanded speed
/// and has only one heading step. Then the thrust, and with it the steering moment, is larger than
/// at steady speed.
bool turns_while_accelerating(const Scenario& scenario) {
  return std::get<HeadingSteps>(scenario.guidance).steps.size() == 1 &&
         scenario.initial.u_mps < scenario.speed_mps;
}

/// Describes why a mode cannot turn the vehicle, and names each change of the vehicle or the
/// scenario that alone lets it turn, with the required number.
std::string describe(const TurningMoment& moment, const DrawnVehicle& vehicle) {
  const std::vector<std::string> found = changes(moment, vehicle);
  std::string text = fmt::format(
      "the largest yaw moment of mode {} at {:.3g} m/s is {:.3g} m, but the yaw resistance at "
      "{:.3g} deg/s is {:.3g} m (both divided by F_max). ",
      name_of(moment.mode), moment.speed_mps, moment.available_m, degrees(kSlowest_radps),
      moment.needed_m);
  if (found.empty()) return text + "Use motors with more force, or reduce the yaw resistance";
  text += "It can turn with ";
  for (std::size_t i = 0; i < found.size(); ++i) text += (i == 0 ? "" : ", or with ") + found[i];
  return text;
}

}  // namespace

TurningMoment turning_moment(const DrawnVehicle& vehicle, double speed_mps, YawMode mode) {
  const Plant<double>& plant = vehicle.plant;
  const Interval force = forces_beyond_dead_zone(vehicle);
  const double steering =
      mode == YawMode::kDifferential ? 0.0 : steered_moment_m(vehicle, speed_mps);
  const double differential =
      mode == YawMode::kSteering
          ? 0.0
          : 0.5 * driven_wheels(plant) * plant.half_track_m * (force.hi - force.lo);
  const double all = steering + differential;
  const double scrub = plant.yaw_scrub_m * differential_share(steering, differential);
  return {.mode = mode,
          .speed_mps = speed_mps,
          .available_m = all,
          .needed_m = plant.yaw.at(kSlowest_radps) + scrub};
}

Status check_turning(const DrawnVehicle& vehicle, std::span<const YawMode> modes,
                     std::span<const Scenario> scenarios, const std::string& model_file) {
  Error error{.kind = ErrorKind::kRefused, .faults = {}};
  for (const YawMode mode : modes) {
    std::optional<TurningMoment> best;
    for (const Scenario& scenario : scenarios) {
      const TurningMoment moment = turning_moment(vehicle, scenario.speed_mps, mode);
      if (moment.turns() || turns_while_accelerating(scenario)) return {};
      if (!best || moment.available_m > best->available_m) best = moment;
    }
    const char* place =
        mode == YawMode::kDifferential ? "/vehicle/wheel_force" : "/vehicle/steering";
    error.faults.push_back({ErrorCode::kNoGains, model_file + ":" + place,
                            "the motors cannot turn the vehicle: " + describe(*best, vehicle)});
  }
  return tl::unexpected(std::move(error));
}

}  // namespace awmr
