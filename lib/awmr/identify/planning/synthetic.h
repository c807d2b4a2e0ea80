/// Simulation of trials and logs with known parameters and known noise, for recover, suggest and
/// tests.
#pragma once

#include <cstdint>

#include "awmr/core/random.h"
#include "awmr/identify/identify.h"

namespace awmr {

/// Sensor noise of a log. Standard deviations, all >= 0.
struct SensorNoise {
  double speed_mps = 0.02;          ///< of wheel encoders
  double yaw_rate_radps = 0.00873;  ///< 0.5 deg/s, of a gyroscope
  double heading_rad = 0.01745;     ///< 1 deg, of a compass
  /// Standard deviation of x and of y. The default is that of a GNSS receiver with corrections.
  double position_m = 0.05;
  double position_rate_hz = 10.0;  ///< update rate of the position, > 0
  double correlation_s = 0.0;      ///< correlation time of each sensor's error; 0: white noise
};

/// Settings of the trials to simulate: one list for each table, with one entry for each row. A
/// table with an empty list is left out.
struct TablePlan {
  std::vector<double> surge_tau_speed;       ///< dimensionless, > 0
  std::vector<double> turning_steering_rad;  ///< d_r, > 0: to the left
  double turning_wheel_force = 0.1;          ///< F' of every wheel, > 0
  /// Wheel forces F' of the turns of a vehicle without steering. The right force is the larger one.
  std::vector<SideForces<double>> turning_sides;
  double surge_distance_m = 10.0;     ///< timed distance of each surge run, > 0
  std::vector<double> stop_from_mps;  ///< initial speeds of the coast-downs, > 0
};

/// Error of one kind of rows.
struct RowError {
  ErrorModel model = ErrorModel::kLogForce;  ///< quantity that has the error
  /// Standard deviation, >= 0, in the unit of the quantity: 1 (force of surge rows; logarithms), m
  /// (moment of turning rows), m/s, rad/s or s.
  double deviation = 0.0;
};
/// Errors of the rows of tables.
struct RowNoise {
  RowError surge, turning;
  double stop_time_s = 0.0;  ///< standard deviation of the stop watch in coast-downs, >= 0
};

/// Simulates the tables: rows at the steady speeds and yaw rates of the plant, with noise. Omits
/// rows whose force does not move the vehicle.
TrialData simulate_tables(const Plant<double>& plant, const TablePlan& plan, const RowNoise& noise,
                          Random& random);

/// Simulates a coast-down from speed_mps, recorded for duration_s at rate_hz. `noise_mps`: standard
/// deviation of the speed noise; `correlation_s`: its correlation time, 0: white.
CoastCurve simulate_coastdown(const Plant<double>& plant, double speed_mps, double duration_s,
                              double rate_hz, double noise_mps, double correlation_s,
                              Random& random);

/// A drive that makes all parameters identifiable. Every `hold_s`, thrust and steering change to
/// random values within the vehicle's limits, with different left and right forces. One change in
/// four switches the motors off, so that the vehicle coasts.
struct DrivePlan {
  double duration_s = 60.0;  ///< duration of the log, > 0
  double rate_hz = 100.0;    ///< rate of the log's rows, > 0
  double hold_s = 1.5;       ///< time between changes of the commands, > 0
  /// True: no steering, and equal left and right forces. Only parameters of surge are then
  /// identifiable.
  bool straight = false;
  bool servo_measured = false;  ///< true: the measured steering angle is logged too
  std::uint64_t drive = 1;      ///< seed of the random commands
};
/// Simulates a log of a drive from rest at the origin. Channels: x, y, heading, speed and yaw rate,
/// each with its noise, and the steering angle if plan.servo_measured and the vehicle has steering.
DrivingLog simulate_log(const Plant<double>& plant, const Vehicle& vehicle, const DrivePlan& plan,
                        const SensorNoise& noise, Random& random);

}  // namespace awmr
