/// Trials and logs simulated at known values with known noise, for recover, suggest and tests.
#pragma once

#include <cstdint>

#include "awmr/core/random.h"
#include "awmr/identify/identify.h"

namespace awmr {

/// Sensor noise of a log: standard deviations, all >= 0.
struct SensorNoise {
  double speed_mps = 0.02;          ///< of wheel encoders
  double yaw_rate_radps = 0.00873;  ///< 0.5 deg/s, of a gyroscope
  double heading_rad = 0.01745;     ///< 1 deg, of a compass
  double position_m = 0.05;         ///< of each of x and y, of a GNSS receiver with corrections
  double position_rate_hz = 10.0;   ///< update rate, > 0; the position is held in between
  double correlation_s = 0.0;       ///< correlation time of every sensor's error; 0: white
};

/// Settings of the runs of a table, in order.
struct TablePlan {
  std::vector<double> surge_tau_speed;       ///< dimensionless, > 0
  std::vector<double> turning_steering_rad;  ///< d_r, > 0: to the left
  double turning_wheel_force = 0.1;          ///< F' of every wheel, > 0
  /// F' of each left and each right wheel of a vehicle without steering, the right one larger.
  std::vector<SideForces<double>> turning_sides;
  double surge_distance_m = 10.0;     ///< timed distance of each surge run, > 0
  std::vector<double> stop_from_mps;  ///< initial speeds of the coast-downs, > 0
};

/// Errors of a table's rows: the quantity, and standard deviations, all >= 0.
struct RowNoise {
  ErrorModel error = ErrorModel::kLogForce;
  double surge = 0.0;        ///< unit by `error`: 1 (of ln tau_speed), tau_speed, m/s or s
  double turning = 0.0;      ///< unit by `error`: 1 (of ln tau_turn), m, rad/s or s
  double stop_time_s = 0.0;  ///< of the stop watch, for every `error`
};

/// Rows at the steady rates of the plant. Excludes rows whose force does not move the vehicle.
TrialData simulate_tables(const Plant<double>& plant, const TablePlan& plan, const RowNoise& noise,
                          Random& random);

/// A coast-down from speed_mps, recorded for duration_s at rate_hz.
CoastCurve simulate_coastdown(const Plant<double>& plant, double speed_mps, double duration_s,
                              double rate_hz, double noise_mps, double correlation_s,
                              Random& random);

/// A drive that makes all parameters identifiable: thrust and steering change every `hold_s` to
/// random levels within the vehicle's limits, at times with different left and right forces.
/// `drive` is the seed of the commands only.
struct DrivePlan {
  double duration_s = 60.0;     ///< > 0
  double rate_hz = 100.0;       ///< > 0, of the log's rows
  double hold_s = 1.5;          ///< > 0
  bool straight = false;        ///< no steering, equal left and right forces: only surge is
                                ///< identifiable
  bool servo_measured = false;  ///< the steering angle is logged in addition to its command
  std::uint64_t drive = 1;      ///< selects the commands
};
/// Simulates a log from rest at the origin: x, y, heading, speed and yaw rate, each with its noise.
DrivingLog simulate_log(const Plant<double>& plant, const Vehicle& vehicle, const DrivePlan& plan,
                        const SensorNoise& noise, Random& random);

}  // namespace awmr
