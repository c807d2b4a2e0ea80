/// Nine vehicles from 2 kg to 300 kg: with steering and with differential drive, servo time
/// constants of 0.02 to 0.15 s, control at 20 to 100 Hz, power-law, linear, quadratic and Coulomb
/// friction. The fifth is the paper's.
#pragma once

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "awmr/core/units.h"
#include "tune/paper_model.h"

namespace awmr::testing {

struct TestVehicle {
  const char* name;
  double mass_kg, length_m, width_m, front_axle_m, half_track_m;
  double steering_max_deg, steering_rate_degps, servo_s;  ///< servo 0: differential drive
  double sample_time_s;
  double motor_force_n;           ///< F_max of one motor
  Resistance<double> surge, yaw;  ///< over F_max
  double sway_alpha;
  double measured_mps, measured_degps;  ///< speed and yaw rate of the fastest trials; 0: unknown
};

inline std::ostream& operator<<(std::ostream& out, const TestVehicle& vehicle) {
  return out << vehicle.name;
}

inline std::vector<TestVehicle> test_vehicles() {
  return {
      {"2 kg car",
       2.0,
       0.40,
       0.20,
       0.13,
       0.08,
       25,
       400,
       0.05,
       0.01,
       4.0,
       {.alpha = 1.0, .beta = 1.0},
       {.alpha = 0.05, .beta = 1.0},
       8.0,
       3.0,
       90},
      {"3 kg car",
       3.0,
       0.45,
       0.25,
       0.16,
       0.11,
       25,
       350,
       0.08,
       0.02,
       6.0,
       {.alpha = 0.15, .beta = 1.0, .quadratic = 0.12},
       {.alpha = 0.06, .beta = 0.9},
       8.0,
       4.0,
       60},
      {"3 kg rover, differential",
       3.0,
       0.30,
       0.25,
       0.11,
       0.11,
       0,
       0,
       0.0,
       0.05,
       8.0,
       {.alpha = 1.2, .beta = 1.0, .coulomb = 0.5},
       {.alpha = 0.05, .beta = 1.0, .coulomb = 0.04},
       6.0,
       1.5,
       90},
      {"9 kg crawler",
       9.0,
       0.60,
       0.40,
       0.22,
       0.17,
       30,
       120,
       0.10,
       0.05,
       60.0,
       {.alpha = 5.0, .beta = 0.7, .coulomb = 1.5},
       {.alpha = 0.25, .beta = 0.7, .coulomb = 0.05},
       20.0,
       0.34,
       12},
      {"37 kg AWMR",
       37.0,
       1.32,
       0.78,
       0.35,
       0.36,
       20,
       300,
       0.02,
       0.01,
       481.8,
       {.alpha = 1.3268, .beta = 0.8933},
       {.alpha = 0.3028, .beta = 0.8250},
       3.0,
       1.66,
       15.2},
      {"60 kg base, differential",
       60.0,
       0.80,
       0.60,
       0.30,
       0.28,
       0,
       0,
       0.0,
       0.02,
       90.0,
       {.alpha = 0.3, .beta = 1.0, .coulomb = 0.3, .quadratic = 0.1},
       {.alpha = 0.12, .beta = 1.2, .coulomb = 0.05},
       5.0,
       2.5,
       60},
      {"120 kg carrier",
       120.0,
       1.50,
       0.90,
       0.50,
       0.40,
       25,
       150,
       0.10,
       0.02,
       250.0,
       {.alpha = 0.9, .beta = 0.7},
       {.alpha = 0.35, .beta = 0.8},
       4.0,
       2.5,
       25},
      {"300 kg tractor",
       300.0,
       2.00,
       1.20,
       0.70,
       0.50,
       30,
       100,
       0.15,
       0.02,
       700.0,
       {.alpha = 0.8, .beta = 0.9},
       {.alpha = 0.6, .beta = 0.8},
       4.0,
       2.0,
       20},
      {"300 kg tractor, slow computer",
       300.0,
       2.00,
       1.20,
       0.70,
       0.50,
       30,
       150,
       0.12,
       0.05,
       700.0,
       {.alpha = 0.5, .beta = 1.2, .coulomb = 0.6},
       {.alpha = 0.5, .beta = 1.0, .coulomb = 0.05},
       4.0,
       0,
       0},
  };
}

/// Steered vehicles with dry friction in yaw, between a sixth and a half of the moment that their
/// steering makes. With the default noise, no steering run settles without a disturbance observer.
inline std::vector<TestVehicle> vehicles_with_dry_friction() {
  TestVehicle awmr = test_vehicles()[4];  // the paper's
  awmr.name = "37 kg AWMR with dry friction";
  awmr.yaw.coulomb = 0.03;
  return {
      {"18 kg rover",
       18.0,
       0.90,
       0.55,
       0.35,
       0.25,
       28,
       260,
       0.05,
       0.01,
       60.0,
       {.alpha = 0.9, .beta = 1.0, .coulomb = 0.3},
       {.alpha = 0.12, .beta = 1.0, .coulomb = 0.03},
       6.0,
       2.5,
       60},
      awmr,
      {"165 kg hauler",
       165.0,
       1.80,
       1.00,
       0.70,
       0.45,
       28,
       110,
       0.10,
       0.04,
       400.0,
       {.alpha = 0.7, .beta = 1.0, .coulomb = 0.4},
       {.alpha = 0.3, .beta = 1.0, .coulomb = 0.05},
       6.0,
       3.0,
       40},
      {"300 kg tractor with dry friction",
       300.0,
       2.40,
       1.40,
       0.90,
       0.60,
       30,
       150,
       0.12,
       0.05,
       900.0,
       {.alpha = 0.5, .beta = 1.0, .coulomb = 0.3},
       {.alpha = 0.35, .beta = 1.0, .coulomb = 0.09},
       6.0,
       3.0,
       30},
  };
}

/// Model of the vehicle with a standard error of 2 % of each resistance and 5 % of m' and I'z,
/// which are fully correlated.
inline Model model_of(const TestVehicle& v) {
  Model model;
  Vehicle& vehicle = model.vehicle;
  const bool is_steered = v.servo_s > 0.0;
  vehicle = {.name = v.name,
             .mass_kg = v.mass_kg,
             .length_m = v.length_m,
             .width_m = v.width_m,
             .drive = is_steered ? Drive::kFourWheel : Drive::kDifferential,
             .front_axle_m = v.front_axle_m,
             .half_track_m = v.half_track_m,
             .wheel_force = {-1.0, 1.0},
             .steering_max_deg = v.steering_max_deg,
             .steering_max_rate_degps = v.steering_rate_degps,
             .steering_time_constant_s = v.servo_s,
             .sample_time_s = v.sample_time_s,
             .yaw_inertia_kgm2 = {},
             .sway_alpha = v.sway_alpha,
             .motor_time_constant_s = {},
             .back_emf_s_per_m = {},
             .motor_stall_power_w = {},
             .yaw_rate_max_degps = {}};
  if (v.measured_degps > 0.0) vehicle.yaw_rate_max_degps = v.measured_degps;
  if (v.measured_mps > 0.0) {
    model.record.trials.push_back({.kind = TrialKind::kSurge,
                                   .file = "surge.csv",
                                   .line = 2,
                                   .input = v.surge(v.measured_mps),
                                   .measured = v.measured_mps,
                                   .predicted = {}});
  }
  const auto family = [](const Resistance<double>& law) {
    if (law.coulomb > 0.0) {
      return law.quadratic > 0.0 ? Family::kCoulombLinearQuadratic : Family::kCoulombPower;
    }
    return law.quadratic > 0.0 ? Family::kCoulombLinearQuadratic : Family::kPower;
  };
  model.surge_family = family(v.surge);
  model.yaw_family = family(v.yaw);
  const double mass_norm = v.mass_kg / v.motor_force_n;
  const double inertia_norm = vehicle.inertia_kgm2() / v.motor_force_n;
  const auto set = [&model](ParameterId id, double value) { model[id].value = value; };
  set(ParameterId::kSurgeAlpha, v.surge.alpha);
  set(ParameterId::kSurgeBeta, v.surge.beta);
  set(ParameterId::kSurgeCoulomb, v.surge.coulomb);
  set(ParameterId::kSurgeQuadratic, v.surge.quadratic);
  set(ParameterId::kYawAlpha, v.yaw.alpha);
  set(ParameterId::kYawBeta, v.yaw.beta);
  set(ParameterId::kYawCoulomb, v.yaw.coulomb);
  set(ParameterId::kYawQuadratic, v.yaw.quadratic);
  set(ParameterId::kSwayAlpha, v.sway_alpha);
  set(ParameterId::kMassNorm, mass_norm);
  set(ParameterId::kInertiaNorm, inertia_norm);
  if (is_steered) set(ParameterId::kSteeringTimeConstant, v.servo_s);
  model.covariance.parameters = {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta,
                                 ParameterId::kYawAlpha,   ParameterId::kYawBeta,
                                 ParameterId::kMassNorm,   ParameterId::kInertiaNorm};
  // Covariance of a power law: w0 is a rate within its trials; ln g(w0) = ln alpha + beta ln w0 and
  // beta have independent standard errors of 0.02.
  constexpr double kError = 0.02 * 0.02;
  const auto of_law = [&](std::size_t at, double alpha, double w0) {
    auto& c = model.covariance.matrix;
    c[at][at] = alpha * alpha * kError * (1.0 + std::log(w0) * std::log(w0));
    c[at][at + 1] = c[at + 1][at] = -alpha * kError * std::log(w0);
    c[at + 1][at + 1] = kError;
  };
  model.covariance.matrix.assign(6, std::vector<double>(6, 0.0));
  of_law(0, v.surge.alpha, v.measured_mps > 0.0 ? 0.5 * v.measured_mps : 1.0);
  of_law(2, v.yaw.alpha, radians(v.measured_degps > 0.0 ? 0.5 * v.measured_degps : 10.0));
  const double inertia[] = {0.05 * mass_norm, 0.05 * inertia_norm};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      model.covariance.matrix[4 + i][4 + j] = inertia[i] * inertia[j];
    }
  }
  return model;
}

}  // namespace awmr::testing
