#include "awmr/identify/logs/problem/initial_guess.h"

#include <cmath>

#include "awmr/core/index.h"

namespace awmr {
namespace {

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

/// Root mean squares of forces and speeds over one log, or the means of these over several logs.
struct Magnitudes {
  double thrust = 0.0;    ///< tau_speed, dimensionless
  double speed = 0.0;     ///< m/s
  double moment = 0.0;    ///< tau_turn: yaw moment divided by F_max, m
  double yaw_rate = 0.0;  ///< rad/s
};

Magnitudes magnitudes(const DrivingLog& log, const Vehicle& vehicle) {
  const double left = rms(log.force_left);
  const double right = rms(log.force_right);
  std::vector<double> difference;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    difference.push_back(log.force_right[i] - log.force_left[i]);
  }
  const double steering = rms(log.driving_steering_rad());
  const auto& speed = log[LogChannel::kSpeed];
  const auto& yaw_rate = log[LogChannel::kYawRate];
  const double of_a_side = 0.5 * vehicle.driven_wheels();
  return {.thrust = of_a_side * (left + right),
          .speed = speed ? rms(speed->value) : 1.0,
          .moment = of_a_side * vehicle.half_track_m * rms(difference) +
                    vehicle.front_axle_m * (left + right) * steering,
          .yaw_rate = yaw_rate ? rms(yaw_rate->value) : 0.2};
}

Magnitudes mean_magnitudes(const std::vector<DrivingLog>& logs, const Vehicle& vehicle) {
  Magnitudes mean;
  const double n = static_cast<double>(logs.size());
  for (const DrivingLog& log : logs) {
    const Magnitudes m = magnitudes(log, vehicle);
    mean.thrust += m.thrust / n;
    mean.speed += m.speed / n;
    mean.moment += m.moment / n;
    mean.yaw_rate += m.yaw_rate / n;
  }
  return mean;
}

/// Returns `value`, or `otherwise` if it is 0 or not finite, as in a log without motion.
double or_else(double value, double otherwise) {
  return value > 1e-6 && std::isfinite(value) ? value : otherwise;
}

}  // namespace

ParameterValues<double> guess_from_logs(const std::vector<DrivingLog>& logs,
                                        const Vehicle& vehicle) {
  constexpr double kTimeConstant_s = 0.3;
  const Magnitudes m = mean_magnitudes(logs, vehicle);
  const auto of_positions = surge_of_positions(logs, vehicle);
  const auto of_headings = yaw_of_headings(logs, vehicle);
  double surge = or_else(m.thrust, 1.0) / std::pow(or_else(m.speed, 1.0), kGuessedBeta);
  double yaw = or_else(m.moment, 0.05) / std::pow(or_else(m.yaw_rate, 0.2), kGuessedBeta);
  double mass = kTimeConstant_s * surge;
  if (of_positions) {
    surge = of_positions->alpha;
    mass = of_positions->inertia;
  }
  double inertia = mass * vehicle.inertia_kgm2() / vehicle.mass_kg;
  if (of_headings) {
    yaw = of_headings->alpha;
    inertia = of_headings->inertia;
  }
  ParameterValues<double> guess{};
  guess[at(ParameterId::kSurgeAlpha)] = surge;
  guess[at(ParameterId::kSurgeBeta)] = kGuessedBeta;
  guess[at(ParameterId::kYawAlpha)] = yaw;
  guess[at(ParameterId::kYawBeta)] = kGuessedBeta;
  guess[at(ParameterId::kSwayAlpha)] = mass / 0.1;
  guess[at(ParameterId::kMassNorm)] = mass;
  guess[at(ParameterId::kInertiaNorm)] = inertia;
  // A vehicle without steering has no servo, so the servo's time constant is arbitrary.
  const double servo_s = vehicle.steering_time_constant_s;
  guess[at(ParameterId::kSteeringTimeConstant)] = servo_s > 0.0 ? servo_s : 0.05;
  return guess;
}

}  // namespace awmr
