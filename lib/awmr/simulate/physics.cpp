#include "awmr/simulate/physics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/gravity.h"
#include "awmr/model/sliding.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

/// Number of RK4 steps per shortest time constant of the plant that does not depend on speed. A
/// larger number is more exact and slower. For an eigenmode with the time constant T, a step h =
/// T/6 has the error (h/T)^5/120 = 1e-6, relative to the excursion; this error decays with T. In
/// tests/peers, positions after a minute differ by 1e-5 m from those of an independent integrator.
constexpr double kStepsPerTimeConstant = 6.0;

/// Up to this speed (m/s or rad/s), a chord (straight line through the origin) may replace a
/// resistance that is too steep near rest for the integration steps. A larger value permits longer
/// steps and makes the motion near rest less exact.
constexpr double kChordSpeed = 1e-3;

double step_for_chord(const Resistance<double>& law, double inertia) {
  if (law.beta >= 1.0 && !(law.coulomb > 0.0)) return std::numeric_limits<double>::infinity();
  return relaxation_time_s(law, inertia, kChordSpeed);
}

/// Limits the command of a motor so that its force F' is at most `most` in magnitude, as on
/// slippery ground. With back-EMF, F' = e - k_e w (motor_force()): drive e, back-EMF coefficient
/// k_e, rolling speed w = `wheel_mps`. So the drive is limited to e = F' + k_e w for the largest
/// F'.
double slipping(const Plant<double>& plant, double command, double wheel_mps, double most) {
  const double k = plant.back_emf_s_per_m;
  const double drive = beyond_dead_zone(command, plant.wheel_dead_zone);
  const double force = motor_force(drive, k, wheel_mps);
  if (std::abs(force) <= most) return command;
  return with_dead_zone(math::saturate(force, most) + k * wheel_mps, plant.wheel_dead_zone);
}

/// Number of integration steps per sample. The tolerance 1e-9 keeps rounding errors from adding a
/// step if a sample has exactly n steps.
double steps_of_sample(const Plant<double>& plant, bool on_tyres, double sample_time_s) {
  return std::max(1.0, std::ceil(sample_time_s / step_limit(plant, on_tyres).step_s - 1e-9));
}

MotorLag motor_lag(const std::optional<Actuators>& actuators, double sample_time_s) {
  const double tau_s = actuators ? actuators->motor_time_constant_s : 0.0;
  if (!(tau_s > 0.0)) return {};
  const double left_over = std::exp(-sample_time_s / tau_s);
  return {left_over, (1.0 - left_over) * tau_s / sample_time_s};
}

}  // namespace

/// The step h is limited by the time constants T that do not depend on speed: sway resistance
/// (m'/a_s), servo and back-EMF.
///   h <= T/6
/// A chord may replace the resistance g (g1 or g3) only below kChordSpeed, which limits the step,
/// too. This is the equation of rest_speed() solved for h; the inertia is m' or I'z:
///   h <= inertia kChordSpeed / g(kChordSpeed)
/// Coulomb friction needs a chord only on tyres (resolved_at_rest()).
StepLimit step_limit(const Plant<double>& with_friction, bool on_tyres) {
  const Plant<double> plant = on_tyres ? with_friction : without_friction(with_friction);
  StepLimit limit{plant.steering_time_constant_s / kStepsPerTimeConstant,
                  ParameterId::kSteeringTimeConstant};
  const auto at_most = [&limit](double step_s, ParameterId parameter) {
    if (step_s < limit.step_s) limit = {step_s, parameter};
  };
  if (plant.sway_alpha > 0.0 && !on_tyres) {
    at_most(plant.mass_norm / plant.sway_alpha / kStepsPerTimeConstant, ParameterId::kSwayAlpha);
  }
  if (const double rate = back_emf_rate(plant); rate > 0.0) {
    at_most(1.0 / rate / kStepsPerTimeConstant, ParameterId::kBackEmf);
  }
  const double rolling = on_tyres ? rolling_inertia(plant) : plant.mass_norm;
  at_most(step_for_chord(plant.surge, rolling), ParameterId::kSurgeBeta);
  if (!on_tyres) {
    at_most(step_for_chord(plant.yaw, plant.inertia_norm), ParameterId::kYawBeta);
  }
  return limit;
}

int substeps_for(const Plant<double>& plant, const Scenario& scenario, double sample_time_s) {
  const double count = steps_of_sample(plant, scenario.tyres.has_value(), sample_time_s);
  return count < kMaxSubsteps ? static_cast<int>(count) : kMaxSubsteps;
}

double steps_of_run(const Plant<double>& plant, const Scenario& scenario, double sample_time_s) {
  return (scenario.duration_s / sample_time_s + 1.0) *
         steps_of_sample(plant, scenario.tyres.has_value(), sample_time_s);
}

VehicleSetup vehicle_setup(const Scenario& scenario, double sample_time_s) {
  VehicleSetup setup;
  setup.lag = motor_lag(scenario.actuators, sample_time_s);
  setup.has_battery = scenario.battery.has_value();
  if (scenario.battery) setup.battery_sag = scenario.battery->sag;
  setup.is_by_wheel = !scenario.faults.empty() || !scenario.patches.empty();
  setup.is_on_tyres = scenario.tyres.has_value();
  setup.tyres = scenario.tyres.value_or(Tyres<double>{});
  setup.push.is_loaded = scenario.disturbance.any();
  if (const auto& slope = scenario.disturbance.slope) {
    setup.push.is_sloped = true;
    setup.push.slope_accel_mps2 = kGravity_mps2 * std::sin(slope->angle_rad);
    setup.push.slope_downhill_rad = slope->downhill_rad;
  }
  return setup;
}

Physics::Physics(const Plant<double>& plant, double force_max, const Scenario& scenario,
                 const SimulateOptions& options)
    : scenario_(&scenario),
      disturbance_(scenario.disturbance, options.sample_time_s,
                   run_seed(scenario.seed, options.seed, options.sample)) {
  const double sample_time_s = options.sample_time_s;
  vehicle_.setup = vehicle_setup(scenario, sample_time_s);
  set_up_vehicle(plant, force_max, scenario, sample_time_s,
                 options.substeps.value_or(substeps_for(plant, scenario, sample_time_s)), 0,
                 vehicle_);
}

void Physics::step(double t_s, const SideForces<double>& force, double steering_command_rad) {
  vehicle_.force = force;
  vehicle_.steering_command_rad = steering_command_rad;
  if (vehicle_.setup.push.is_loaded) vehicle_.load = disturbance_.next(t_s);
  step_vehicles(*scenario_, t_s, kOneVehicleSteps, vehicle_);
}

Plant<double> resolved_at_rest(const Plant<double>& plant, const Scenario& scenario,
                               double step_s) {
  return scenario.tyres ? resolved_at_rest_on_tyres(plant, step_s)
                        : resolved_at_rest(without_friction(plant), step_s);
}

WheelForces<double> at_the_ground(const Scenario& scenario, const Plant<double>& plant,
                                  const State<double>& state, double t_s,
                                  const SideForces<double>& force) {
  const double rear = plant.rear_driven;
  double wheels[] = {force.left, force.right, rear * force.left, rear * force.right};  // as Wheel
  for (const WheelFault& fault : scenario.faults) {
    if (!fault.window.holds(t_s)) continue;
    for (const Wheel wheel : fault.wheels) wheels[static_cast<int>(wheel)] *= fault.share;
  }
  const WheelSpeeds<double> w = wheel_speeds(plant.front_axle_m, plant.half_track_m, state);
  const double rolling[] = {w.front_left, w.front_right, w.rear_left, w.rear_right};
  const double cos_psi = std::cos(state.psi_rad);
  const double sin_psi = std::sin(state.psi_rad);
  for (const SlipperyPatch& patch : scenario.patches) {
    for (int wheel = 0; wheel < 4; ++wheel) {
      const double ahead_m = wheel < 2 ? plant.front_axle_m : -plant.front_axle_m;
      const double left_m = wheel % 2 == 0 ? plant.half_track_m : -plant.half_track_m;
      const Position<double> at{state.x_m + ahead_m * cos_psi - left_m * sin_psi,
                                state.y_m + ahead_m * sin_psi + left_m * cos_psi};
      if (squared_distance_m2(at, patch.centre_m) > patch.radius_m * patch.radius_m) continue;
      wheels[wheel] = slipping(plant, wheels[wheel], rolling[wheel], patch.force_max);
    }
  }
  return {wheels[0], wheels[1], wheels[2], wheels[3]};
}

double battery_share(const Battery& battery, double t_s) {
  const double gone =
      math::clamp((t_s - battery.from_s) / (battery.to_s - battery.from_s), 0.0, 1.0);
  return 1.0 - gone * (1.0 - battery.share_end);
}

void quantise(const Actuators& actuators, double force_max, SideForces<double>& force,
              double& steering_command_rad) {
  if (actuators.steering_quantum_rad > 0.0) {
    steering_command_rad = actuators.steering_quantum_rad *
                           std::round(steering_command_rad / actuators.steering_quantum_rad);
  }
  if (actuators.pwm_counts > 0) {
    const double count = force_max / actuators.pwm_counts;
    force = {count * std::round(force.left / count), count * std::round(force.right / count)};
  }
}

}  // namespace awmr
