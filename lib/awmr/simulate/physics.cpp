#include "awmr/simulate/physics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/gravity.h"
#include "awmr/model/rest.h"
#include "awmr/model/runge_kutta.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

/// RK4 steps per fastest time constant of the smooth part of the plant: the local error of a mode
/// of time constant T is (h/T)^5/120, so 6 keeps it near 1e-6 of the excursion, and what it leaves
/// dies out with T; the positions after a minute are held to CVODE's within 1e-5 m.
constexpr double kStepsPerTimeConstant = 6.0;

/// The largest speed (m/s, rad/s) below which resistance may be its chord.
constexpr double kChordSpeed = 1e-3;

/// Streams of RunSeed::random: at most 200 terms an axis.
constexpr std::uint64_t kSurgeUse = 100;
constexpr std::uint64_t kSwayUse = 300;
constexpr std::uint64_t kYawUse = 500;

/// The largest product of a rate (1/s) and an RK4 step: a deviation that dies out at this rate
/// does so without changing its sign, and Runge-Kutta is stable to 2.78.
constexpr double kMostRateTimesStep = 1.0;

/// A step is halved at most this often, and a run has at most so many halves.
constexpr int kMostHalvings = 40;
constexpr long kMostHalves = 50'000'000;

/// g'(w)/inertia, at which a deviation from the speed w dies out:
///   g'(w) = alpha beta |w|^(beta-1) + 2 q |w|
/// For beta <= 1 it falls with |w| and is below 1/h from the chord's end on, by the choice of h.
double decay_rate(const Resistance<double>& law, double inertia, double speed) {
  const double w = std::abs(speed);
  if (law.beta < 1.0 && !(law.quadratic > 0.0)) return 0.0;
  if (w < law.rest_speed) return 0.0;
  const double slope = law.beta > 0.0 ? law.alpha * law.beta * std::pow(w, law.beta - 1.0) : 0.0;
  return (slope + 2.0 * law.quadratic * w) / inertia;
}

bool is_finite(const State<double>& s) {
  return std::isfinite(s.x_m) && std::isfinite(s.y_m) && std::isfinite(s.psi_rad) &&
         std::isfinite(s.u_mps) && std::isfinite(s.v_mps) && std::isfinite(s.r_radps) &&
         std::isfinite(s.steering_rad);
}

double step_for_chord(const Resistance<double>& law, double inertia) {
  if (law.beta >= 1.0 && !(law.coulomb > 0.0)) return std::numeric_limits<double>::infinity();
  return inertia * kChordSpeed / law.at(kChordSpeed);
}

/// A speed whose square would be below the normal range is rest: no crawl through subnormal
/// numbers.
void settle(double& speed) {
  if (std::abs(speed) < 1e-150) speed = 0.0;
}

RunSeed seed_of(const Scenario& scenario, const SimulateOptions& options) {
  return run_seed(scenario.seed, options.seed, options.sample);
}

/// Steps of a sample; with room for rounding, so that a sample of exactly n steps takes n.
double steps_of_sample(const Plant<double>& plant, double sample_time_s) {
  return std::max(1.0, std::ceil(sample_time_s / step_limit(plant).step_s - 1e-9));
}

}  // namespace

/// h <= T/6 for the time constants that do not depend on speed, m'/a_s of sway and T of the servo;
/// and h such that resistance is its chord only below kChordSpeed (rest_speed() solved for h):
///   h <= inertia kChordSpeed / g(kChordSpeed)
StepLimit step_limit(const Plant<double>& plant) {
  StepLimit limit{plant.steering_time_constant_s / kStepsPerTimeConstant,
                  ParameterId::kSteeringTimeConstant};
  const auto at_most = [&limit](double step_s, ParameterId parameter) {
    if (step_s < limit.step_s) limit = {step_s, parameter};
  };
  if (plant.sway_alpha > 0.0) {
    at_most(plant.mass_norm / plant.sway_alpha / kStepsPerTimeConstant, ParameterId::kSwayAlpha);
  }
  at_most(step_for_chord(plant.surge, plant.mass_norm), ParameterId::kSurgeBeta);
  at_most(step_for_chord(plant.yaw, plant.inertia_norm), ParameterId::kYawBeta);
  return limit;
}

int substeps_for(const Plant<double>& plant, double sample_time_s) {
  const double count = steps_of_sample(plant, sample_time_s);
  return count < kMostSubsteps ? static_cast<int>(count) : kMostSubsteps;
}

double steps_of_run(const Plant<double>& plant, double duration_s, double sample_time_s) {
  return (duration_s / sample_time_s + 1.0) * steps_of_sample(plant, sample_time_s);
}

Physics::Physics(const Plant<double>& plant, double force_max, const Scenario& scenario,
                 const SimulateOptions& options)
    : plant_(plant),
      force_max_(force_max),
      scenario_(&scenario),
      sample_time_s_(options.sample_time_s),
      substeps_(options.substeps.value_or(substeps_for(plant, options.sample_time_s))),
      state_(scenario.initial),
      surge_(scenario.disturbance.surge, sample_time_s_, seed_of(scenario, options), kSurgeUse),
      sway_(scenario.disturbance.sway, sample_time_s_, seed_of(scenario, options), kSwayUse),
      yaw_(scenario.disturbance.yaw, sample_time_s_, seed_of(scenario, options), kYawUse),
      loaded_(scenario.disturbance.any()),
      by_wheel_(!scenario.faults.empty() || !scenario.patches.empty()) {
  plant_ = resolved_at_rest(plant, sample_time_s_ / substeps_);
}

const BodyLoad& Physics::disturb(double t_s) {
  if (loaded_) load_ = {surge_.next(t_s), sway_.next(t_s), yaw_.next(t_s)};
  return load_;
}

/// What of each wheel's commanded force arrives: the battery's limit, the motor's fault, and the
/// ground under it. The rear axle is taken as far behind the centre of gravity as the front one is
/// before it.
WheelForces<double> Physics::at_the_ground(double t_s, const SideForces<double>& force) const {
  double wheels[] = {force.left, force.right, force.left, force.right};  // by Wheel
  for (const WheelFault& fault : scenario_->faults) {
    if (!fault.window.holds(t_s)) continue;
    for (const Wheel wheel : fault.wheels) wheels[static_cast<int>(wheel)] *= fault.share;
  }
  const double cos_psi = std::cos(state_.psi_rad);
  const double sin_psi = std::sin(state_.psi_rad);
  for (const SlipperyPatch& patch : scenario_->patches) {
    for (int wheel = 0; wheel < 4; ++wheel) {
      const double ahead_m = wheel < 2 ? plant_.front_axle_m : -plant_.front_axle_m;
      const double left_m = wheel % 2 == 0 ? plant_.half_track_m : -plant_.half_track_m;
      const Position<double> at{state_.x_m + ahead_m * cos_psi - left_m * sin_psi,
                                state_.y_m + ahead_m * sin_psi + left_m * cos_psi};
      if (squared_distance_m2(at, patch.centre_m) > patch.radius_m * patch.radius_m) continue;
      wheels[wheel] = math::saturate(wheels[wheel], patch.force_max);
    }
  }
  return {wheels[0], wheels[1], wheels[2], wheels[3]};
}

template <class Forces>
State<double> Physics::rates(const State<double>& at, const Forces& force,
                             double steering_command_rad) const {
  State<double> d = state_rates(plant_, at, force, steering_command_rad);
  if (!loaded_) return d;
  d.u_mps += load_.surge / plant_.mass_norm;
  d.v_mps += load_.sway / plant_.mass_norm;
  d.r_radps += load_.yaw_m / plant_.inertia_norm;
  if (const auto& slope = scenario_->disturbance.slope) {
    // m g sin(slope) downhill: over m it is the same for every vehicle.
    const double accel_mps2 = kGravity_mps2 * std::sin(slope->angle_rad);
    d.u_mps += accel_mps2 * std::cos(slope->downhill_rad - at.psi_rad);
    d.v_mps += accel_mps2 * std::sin(slope->downhill_rad - at.psi_rad);
  }
  return d;
}

/// Faster than this nothing of the plant changes at `at`: resistance that grows with speed, and
/// the turning of the velocity in the vehicle's frame (m' r v and m' r u), at r.
double Physics::fastest_rate(const State<double>& at) const {
  return std::max({std::abs(at.r_radps), decay_rate(plant_.surge, plant_.mass_norm, at.u_mps),
                   decay_rate(plant_.yaw, plant_.inertia_norm, at.r_radps)});
}

/// One step of the classical Runge-Kutta method where it resolves the rates at both of its ends,
/// else two of half the length.
template <class Rates>
State<double> Physics::advance(const State<double>& from, double h, const Rates& rates,
                               int halvings) {
  if (fastest_rate(from) * h <= kMostRateTimesStep) {
    const State<double> to = rk4_step(from, h, rates);
    if (fastest_rate(to) * h <= kMostRateTimesStep) return to;
  }
  if (halvings == kMostHalvings || halves_ == kMostHalves) resolved_ = false;
  if (!resolved_) return from;
  ++halves_;
  const State<double> middle = advance(from, h / 2.0, rates, halvings + 1);
  return advance(middle, h / 2.0, rates, halvings + 1);
}

/// Over one sample, commands held.
template <class Forces>
void Physics::integrate(const Forces& force, double steering_command_rad) {
  const double h = sample_time_s_ / substeps_;
  State<double> state = state_;
  for (int i = 0; i < substeps_ && resolved_; ++i) {
    state = advance(
        state, h, [&](const State<double>& at) { return rates(at, force, steering_command_rad); },
        0);
  }
  resolved_ = resolved_ && is_finite(state);
  if (!resolved_) return;
  state_ = state;
  settle(state_.u_mps);
  settle(state_.v_mps);
  settle(state_.r_radps);
}

/// The mean over one sample of what the motors make of a command c that is held, from their force F
/// at its start:
///   F(t) = c + (F - c) exp(-t/tau),   mean = c + (F - c) (1 - exp(-T_s/tau)) tau/T_s
SideForces<double> Physics::through_motors(const SideForces<double>& command) {
  const double tau_s = scenario_->actuators ? scenario_->actuators->motor_time_constant_s : 0.0;
  if (!(tau_s > 0.0)) return command;
  const double left_over = std::exp(-sample_time_s_ / tau_s);
  const double mean_share = (1.0 - left_over) * tau_s / sample_time_s_;
  const SideForces<double> behind{motors_.left - command.left, motors_.right - command.right};
  motors_ = {command.left + behind.left * left_over, command.right + behind.right * left_over};
  return {command.left + behind.left * mean_share, command.right + behind.right * mean_share};
}

void Physics::step(double t_s, const SideForces<double>& commanded, double steering_command_rad) {
  SideForces<double> force = through_motors(commanded);
  if (const auto& battery = scenario_->battery) {
    const double gone =
        math::clamp((t_s - battery->from_s) / (battery->to_s - battery->from_s), 0.0, 1.0);
    const double most = force_max_ * (1.0 - gone * (1.0 - battery->share_end));
    force = {math::saturate(force.left, most), math::saturate(force.right, most)};
  }
  if (by_wheel_) {
    integrate(at_the_ground(t_s, force), steering_command_rad);
  } else {
    integrate(force, steering_command_rad);
  }
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
