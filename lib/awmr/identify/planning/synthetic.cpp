#include "awmr/identify/planning/synthetic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/sliding.h"
#include "awmr/model/steady.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

/// Source of noise e_k with a given standard deviation: white (w_k), or first-order with the
/// correlation time T and samples h apart:
///   e_k = phi e_{k-1} + sqrt(1 - phi^2) w_k,   phi = exp(-h/T)
class NoiseSource {
 public:
  NoiseSource(double std, double correlation_s, double step_s)
      : std_(std), phi_(correlation_s > 0.0 ? std::exp(-step_s / correlation_s) : 0.0) {}

  double next(Random& random) {
    const double w = random.normal();
    value_ = first_ ? w : phi_ * value_ + std::sqrt(1.0 - phi_ * phi_) * w;
    first_ = false;
    return std_ * value_;
  }

 private:
  double std_;
  double phi_;
  double value_ = 0.0;
  bool first_ = true;
};

/// A simulated row of a table: force, rate (speed or yaw rate) and time. One of these has the
/// measurement error. The run covers its given distance or angle in this time.
struct NoisyRow {
  double force;
  double rate;
  double elapsed_s;
};

NoisyRow noisy(double force, double rate, double travel, const RowError& error, Random& random) {
  const double e = error.deviation * random.normal();
  NoisyRow row{force, rate, travel / rate};
  switch (error.model) {
    case ErrorModel::kLogForce:
      row.force = force * std::exp(e);
      break;
    case ErrorModel::kForce:
      row.force = force + e;
      break;
    case ErrorModel::kSpeed:
      row.rate = rate + e;
      row.elapsed_s = travel / row.rate;
      break;
    case ErrorModel::kTime:
      row.elapsed_s = travel / rate + e;
      row.rate = travel / row.elapsed_s;
      break;
  }
  return row;
}

/// Simulates surge runs: solves g1(u) = tau_speed for the steady speed u, with the surge resistance
/// g1. Subtracts the wheels' dead zones from tau_speed first.
TrialSet<SurgeRow> surge_rows(const Plant<double>& plant, const TablePlan& plan,
                              const RowNoise& noise, Random& random) {
  TrialSet<SurgeRow> set{"simulated surge", {}, 0};
  int line = 2;
  for (const double tau : plan.surge_tau_speed) {
    const auto speed = steady_rate(plant.surge, tau - driven_wheels(plant) * plant.wheel_dead_zone);
    if (!speed) continue;
    const NoisyRow row = noisy(tau, *speed, plan.surge_distance_m, noise.surge, random);
    set.rows.push_back({line++, row.force, row.rate, plan.surge_distance_m, row.elapsed_s});
  }
  return set;
}

/// Simulates steered turns: solves g3(r) = 2 l_f F' sin d_r for the steady yaw rate r, with the yaw
/// resistance g3 and the steering angle d_r. Subtracts the dead zone from the wheel force F' first.
TrialSet<TurningRow> turning_rows(const Plant<double>& plant, const TablePlan& plan,
                                  const RowNoise& noise, Random& random) {
  TrialSet<TurningRow> set{"simulated turning", {}, 0};
  int line = 2;
  for (const double angle : plan.turning_steering_rad) {
    const double effective = plan.turning_wheel_force - plant.wheel_dead_zone;
    const double tau = steering_moment_m(plant.front_axle_m, effective, angle);
    const auto rate = steady_rate(plant.yaw, tau);
    if (!rate) continue;
    const NoisyRow row = noisy(tau, *rate, 2.0 * std::numbers::pi, noise.turning, random);
    set.rows.push_back({.line = line++,
                        .steering_rad = angle,
                        .wheel_force = plan.turning_wheel_force,
                        .tau_turn_m = row.force * plan.turning_wheel_force / effective,
                        .yaw_rate_radps = row.rate,
                        .turns = 1.0,
                        .elapsed_s = row.elapsed_s});
  }
  return set;
}

/// Simulates differential turns: solves g3(r) = 2 d (F'R - F'L) for the steady yaw rate r, with the
/// yaw resistance g3. Subtracts the dead zone from the wheel forces F'R and F'L first.
TrialSet<TurningRow> sides_turning_rows(const Plant<double>& plant, const TablePlan& plan,
                                        const RowNoise& noise, Random& random) {
  TrialSet<TurningRow> set{"simulated turning", {}, 0};
  int line = 2;
  for (const SideForces<double>& sides : plan.turning_sides) {
    const double commanded = sides.right - sides.left;
    const double effective = beyond_dead_zone(sides.right, plant.wheel_dead_zone) -
                             beyond_dead_zone(sides.left, plant.wheel_dead_zone);
    const double tau = differential_moment_m(plant.half_track_m, effective);
    const auto rate = steady_rate(plant.yaw, tau);
    if (!rate) continue;
    const NoisyRow row = noisy(tau, *rate, 2.0 * std::numbers::pi, noise.turning, random);
    set.rows.push_back({.line = line++,
                        .tau_turn_m = row.force * commanded / effective,
                        .yaw_rate_radps = row.rate,
                        .turns = 1.0,
                        .elapsed_s = row.elapsed_s,
                        .sides = sides});
  }
  return set;
}

TrialSet<StopTimeRow> stop_rows(const Plant<double>& plant, const TablePlan& plan,
                                const RowNoise& noise, Random& random) {
  TrialSet<StopTimeRow> set{"simulated coast-down", {}, 0};
  int line = 2;
  for (const double speed : plan.stop_from_mps) {
    const auto stop_s = stop_time_s(plant.surge, plant.mass_norm, speed);
    if (!stop_s) continue;
    set.rows.push_back(
        {line++, speed, *stop_s + noise.stop_time_s * random.normal(), noise.stop_time_s});
  }
  return set;
}

}  // namespace

TrialData simulate_tables(const Plant<double>& plant, const TablePlan& plan, const RowNoise& noise,
                          Random& random) {
  TrialData data;
  if (!plan.surge_tau_speed.empty()) data.surge = surge_rows(plant, plan, noise, random);
  if (!plan.turning_steering_rad.empty()) data.turning = turning_rows(plant, plan, noise, random);
  if (!plan.turning_sides.empty()) data.turning = sides_turning_rows(plant, plan, noise, random);
  if (!plan.stop_from_mps.empty()) data.coastdown = stop_rows(plant, plan, noise, random);
  return data;
}

CoastCurve simulate_coastdown(const Plant<double>& plant, double speed_mps, double duration_s,
                              double rate_hz, double noise_mps, double correlation_s,
                              Random& random) {
  CoastCurve curve{"simulated coast-down", 2, {}, {}};
  NoiseSource noise(noise_mps, correlation_s, 1.0 / rate_hz);
  const auto rows = static_cast<int>(std::lround(duration_s * rate_hz));
  constexpr double kStep_s = 1e-4;
  const Plant<double> resolved = resolved_beside_friction(plant, kStep_s);
  State<double> state{};
  state.u_mps = speed_mps;
  const int steps = std::max(1, static_cast<int>(std::lround(1.0 / (rate_hz * kStep_s))));
  for (int i = 0; i <= rows; ++i) {
    curve.t_s.push_back(i / rate_hz);
    curve.speed_mps.push_back(state.u_mps + noise.next(random));
    for (int n = 0; n < steps; ++n) {
      state = rk4_step(state, 1.0 / (rate_hz * steps), [&](const State<double>& at) {
        return state_rates(resolved, at, SideForces<double>{0.0, 0.0}, 0.0);
      });
    }
  }
  return curve;
}

namespace {

/// Writes the commands of a drive (DrivePlan) into `log`.
void command_drive(const Vehicle& vehicle, const DrivePlan& plan, DrivingLog& log) {
  Random random(plan.drive, 7);
  const auto rows = static_cast<int>(std::lround(plan.duration_s * plan.rate_hz));
  const auto hold = static_cast<int>(std::max(1.0, plan.hold_s * plan.rate_hz));
  const double most = vehicle.wheel_force.hi;
  const double turn = plan.straight ? 0.0 : 1.0;
  double left = 0.0;
  double right = 0.0;
  double steering = 0.0;
  log.steering_command_rad.emplace();
  for (int i = 0; i <= rows; ++i) {
    if (i % hold == 0) {
      // One change in four switches the motors off, so that the vehicle coasts.
      const double level = random.uniform() < 0.25 ? 0.0 : most * (0.15 + 0.65 * random.uniform());
      const double apart = turn * (random.uniform() - 0.5) * 0.4 * level;
      steering = turn * radians(vehicle.steering_max_deg) * (1.6 * random.uniform() - 0.8);
      left = std::max(vehicle.wheel_force.lo, level - apart);
      right = std::min(most, level + apart);
    }
    log.line.push_back(i + 2);
    log.t_s.push_back(i / plan.rate_hz);
    log.force_left.push_back(left);
    log.force_right.push_back(right);
    log.steering_command_rad->push_back(steering);
  }
}

double std_of(const SensorNoise& noise, LogChannel channel) {
  switch (channel) {
    case LogChannel::kX:
    case LogChannel::kY:
      return noise.position_m;
    case LogChannel::kHeading:
      return noise.heading_rad;
    case LogChannel::kSpeed:
      return noise.speed_mps;
    case LogChannel::kYawRate:
      return noise.yaw_rate_radps;
    case LogChannel::kSway:
    case LogChannel::kSteering:
      break;
  }
  // Standard deviation of the noise of a measured steering angle, rad.
  return 0.002;
}

/// Measurements of a channel: true values with noise, sampled every `stride` rows and repeated
/// until the next sample.
Measured measured(const std::vector<State<double>>& truth, LogChannel channel, std::size_t stride,
                  NoiseSource source, Random& random) {
  Measured result{std::vector<double>(truth.size()), std::vector<bool>(truth.size(), false), 0,
                  stride > 1};
  for (std::size_t row = 0; row < truth.size(); ++row) {
    if (row % stride == 0) {
      result.value[row] = channel_of(truth[row], channel) + source.next(random);
      result.fresh[row] = true;
      ++result.fresh_count;
    } else {
      result.value[row] = result.value[row - 1];
    }
  }
  return result;
}

}  // namespace

DrivingLog simulate_log(const Plant<double>& plant, const Vehicle& vehicle, const DrivePlan& plan,
                        const SensorNoise& noise, Random& random) {
  DrivingLog log;
  log.file = "simulated log";
  command_drive(vehicle, plan, log);
  std::vector<State<double>> truth(log.rows());
  const double step_s = std::min(1e-3, replay_step_s(plant));
  replay<double>(LogSignals(log), 0, log.rows(), resolved_beside_friction(plant, step_s), nullptr,
                 step_s, State<double>{},
                 [&](std::size_t row, const State<double>& state) { truth[row] = state; });

  std::vector<LogChannel> channels{LogChannel::kX, LogChannel::kY, LogChannel::kHeading,
                                   LogChannel::kSpeed, LogChannel::kYawRate};
  if (plan.servo_measured && vehicle.has_steering()) channels.push_back(LogChannel::kSteering);
  const auto every =
      static_cast<std::size_t>(std::max(1.0, std::round(plan.rate_hz / noise.position_rate_hz)));
  for (const LogChannel channel : channels) {
    const bool position = channel == LogChannel::kX || channel == LogChannel::kY;
    const std::size_t stride = position ? every : 1;
    const NoiseSource source(std_of(noise, channel), noise.correlation_s,
                             static_cast<double>(stride) / plan.rate_hz);
    log[channel] = measured(truth, channel, stride, source, random);
  }
  return log;
}

}  // namespace awmr
