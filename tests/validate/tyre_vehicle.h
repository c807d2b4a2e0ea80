/// Simulator of a vehicle on four tyres that shares no code with the library, and logs of the
/// vehicle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/model.h"
#include "awmr/trials/log.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {

inline constexpr double kMass = 0.4;
inline constexpr double kInertia = 0.063;
inline constexpr double kAlpha = 1.2;
inline constexpr double kBeta = 0.7;
inline constexpr double kAxle_m = 0.35;
inline constexpr double kTrack_m = 0.36;
inline constexpr double kServo_s = 0.05;

/// State: x, y, psi, u, v, r, d_r.
using Numbers = std::array<double, 7>;

struct Commands {
  double left;
  double right;
  double steering_rad;
};

/// Rates by the equations of lib/awmr/model/VEHICLES.md.
inline Numbers rates(const Numbers& s, const Commands& c, double friction, double stiffness) {
  const double load = kMass * 9.80665 / 4.0;
  const double cos_d = std::cos(s[6]);
  const double sin_d = std::sin(s[6]);
  double x = 0.0;
  double y = 0.0;
  double moment = 0.0;
  for (const bool front : {true, false}) {
    for (const double side : {1.0, -1.0}) {  // 1: left
      const double at_x = front ? kAxle_m : -kAxle_m;
      const double at_y = side * kTrack_m;
      const double along_body = s[3] - at_y * s[5];
      const double across_body = s[4] + at_x * s[5];
      const double cd = front ? cos_d : 1.0;
      const double sd = front ? sin_d : 0.0;
      const double rolls = along_body * cd + across_body * sd;
      const double slides = across_body * cd - along_body * sd;
      const double slow = std::min(1.0, std::abs(rolls) / 1e-3);
      const double resists = kAlpha / 4.0 * std::pow(std::max(std::abs(rolls), 1e-3), kBeta) *
                             slow * (rolls < 0.0 ? -1.0 : 1.0);
      const double grip = friction * load;
      const double fx = std::clamp((side > 0.0 ? c.left : c.right) - resists, -grip, grip);
      const double most = std::sqrt(std::max(0.0, grip * grip - fx * fx));
      const double sigma = std::abs(slides) / std::hypot(rolls, 0.1);
      const double z = most > 0.0 ? std::min(1.0, stiffness * load * sigma / (3.0 * most)) : 1.0;
      const double fy = most * (1.0 - std::pow(1.0 - z, 3)) * (slides > 0.0 ? -1.0 : 1.0);
      const double in_x = fx * cd - fy * sd;
      const double in_y = fx * sd + fy * cd;
      x += in_x;
      y += in_y;
      moment += at_x * in_y - at_y * in_x;
    }
  }
  return {s[3] * std::cos(s[2]) - s[4] * std::sin(s[2]),
          s[3] * std::sin(s[2]) + s[4] * std::cos(s[2]),
          s[5],
          x / kMass + s[5] * s[4],
          y / kMass - s[5] * s[3],
          moment / kInertia,
          (c.steering_rad - s[6]) / kServo_s};
}

inline Numbers plus(const Numbers& a, double h, const Numbers& b) {
  Numbers sum{};
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = a[i] + h * b[i];
  return sum;
}

struct LogDrive {
  double friction = 0.8;
  double stiffness = 10.0;
  double duration_s = 60.0;
  bool by_sides = true;
  bool by_steering = true;
  double force = 0.45;         ///< largest mean of the left and right forces, over F_max
  double apart = 0.5;          ///< largest difference of the right and left forces, over F_max
  double steering_deg = 20.0;  ///< largest steering angle
  unsigned seed = 1;
};

/// Commands of a drive in parts of 4 s: a differential turn, a steered turn, or a steered turn that
/// coasts for its first second.
inline Commands commands(const LogDrive& drive, double t_s) {
  const int part = static_cast<int>(t_s / 4.0);
  std::mt19937 random(drive.seed * 1000 + static_cast<unsigned>(part));
  std::uniform_real_distribution<double> share(0.3, 1.0);
  const double sign = random() % 2 == 0 ? 1.0 : -1.0;
  const double force = drive.force * share(random);
  const bool sides = drive.by_sides && (!drive.by_steering || part % 3 == 0);
  if (sides) {
    const double half = 0.5 * drive.apart * share(random) * sign;
    return {force - half, force + half, 0.0};
  }
  const double steering_rad = radians(drive.steering_deg) * share(random) * sign;
  if (part % 3 == 2 && t_s - 4.0 * part < 1.0) return {0.0, 0.0, steering_rad};
  return {force, force, steering_rad};
}

inline Measured measured(std::size_t rows) {
  return {std::vector<double>(rows), std::vector<bool>(rows, true), static_cast<int>(rows), false};
}

/// Log at 50 Hz with noise of 2 cm/s (speed), 0.5 deg/s (yaw rate) and 1 deg (heading).
inline DrivingLog driven(const LogDrive& drive) {
  constexpr int kStepsOfRow = 40;
  constexpr double kStep_s = 0.02 / kStepsOfRow;
  const auto rows = static_cast<std::size_t>(drive.duration_s * 50.0);
  DrivingLog log;
  log.file = "drive.csv";
  log.steering_command_rad.emplace();
  log[LogChannel::kSpeed] = measured(rows);
  log[LogChannel::kYawRate] = measured(rows);
  log[LogChannel::kHeading] = measured(rows);
  std::mt19937 random(drive.seed);
  std::normal_distribution<double> normal;
  Numbers s{};
  for (std::size_t row = 0; row < rows; ++row) {
    const double t_s = 0.02 * static_cast<double>(row);
    const Commands c = commands(drive, t_s);
    log.line.push_back(static_cast<int>(row) + 2);
    log.t_s.push_back(t_s);
    log.force_left.push_back(c.left);
    log.force_right.push_back(c.right);
    log.steering_command_rad->push_back(c.steering_rad);
    log[LogChannel::kSpeed]->value[row] = s[3] + 0.02 * normal(random);
    log[LogChannel::kYawRate]->value[row] = s[5] + radians(0.5) * normal(random);
    log[LogChannel::kHeading]->value[row] = s[2] + radians(1.0) * normal(random);
    for (int i = 0; i < kStepsOfRow; ++i) {
      const auto at = [&](const Numbers& state) {
        return rates(state, c, drive.friction, drive.stiffness);
      };
      const Numbers k1 = at(s);
      const Numbers k2 = at(plus(s, kStep_s / 2.0, k1));
      const Numbers k3 = at(plus(s, kStep_s / 2.0, k2));
      const Numbers k4 = at(plus(s, kStep_s, k3));
      for (std::size_t j = 0; j < s.size(); ++j) {
        s[j] += kStep_s / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]);
      }
    }
  }
  return log;
}

/// Model of the vehicle as identified from tables: m', g1, I'z = m' Iz/m, and g3 from steered
/// turns.
inline Model identified() {
  Model model;
  model.vehicle = paper_vehicle();
  model.vehicle.front_axle_m = kAxle_m;
  model.vehicle.half_track_m = kTrack_m;
  model.vehicle.steering_time_constant_s = kServo_s;
  model.vehicle.steering_max_rate_degps = 1e4;
  const auto set = [&model](ParameterId id, double value, Source source) {
    model[id].value = value;
    model[id].source = source;
  };
  set(ParameterId::kMassNorm, kMass, Source::kFitted);
  set(ParameterId::kInertiaNorm, kInertia, Source::kDerived);
  set(ParameterId::kSurgeAlpha, kAlpha, Source::kFitted);
  set(ParameterId::kSurgeBeta, kBeta, Source::kFitted);
  set(ParameterId::kYawAlpha, 0.15, Source::kFitted);
  set(ParameterId::kYawBeta, 0.97, Source::kFitted);
  set(ParameterId::kSwayAlpha, 13.0, Source::kDerived);
  set(ParameterId::kSteeringTimeConstant, kServo_s, Source::kGiven);
  return model;
}

/// Distance of an estimate from the truth, in standard errors of its logarithm.
inline double log_errors_off(const Estimate& estimate, double truth) {
  return std::abs(std::log(*estimate.value / truth)) / (*estimate.std_error / *estimate.value);
}

}  // namespace awmr::testing
