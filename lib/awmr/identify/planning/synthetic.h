/// Trials and logs simulated at known values, with known noise: what recover, suggest and the tests
/// run on.
#pragma once

#include <cstdint>

#include "awmr/core/random.h"
#include "awmr/identify/identify.h"

namespace awmr {

/// What a log's sensors do to the truth.
struct SensorNoise {
  double speed_mps = 0.02;
  double yaw_rate_radps = 0.00873;  ///< 0.5 deg/s
  double heading_rad = 0.01745;     ///< 1 deg
  double position_m = 0.05;
  double position_rate_hz = 10.0;  ///< the receiver's; held between
  double correlation_s = 0.0;      ///< of every sensor's error; 0: white
};

/// The runs of a table: what was set, in order.
struct TablePlan {
  std::vector<double> surge_tau_speed;
  std::vector<double> turning_steering_rad;
  double turning_wheel_force = 0.1;
  double surge_distance_m = 10.0;
  std::vector<double> stop_from_mps;
};

/// Where the error of a table's rows lies, and its standard deviation in that unit.
enum class RowError { kLogForce, kForce, kSpeed, kTime };
struct RowNoise {
  RowError error = RowError::kLogForce;
  double surge = 0.0;
  double turning = 0.0;
  double stop_time_s = 0.0;
};

/// Rows at the plant's own steady rates. Rows whose force does not move the vehicle are left out.
TrialData simulate_tables(const Plant<double>& plant, const TablePlan& plan, const RowNoise& noise,
                          Random& random);

/// A coast-down from speed_mps, recorded for duration_s at rate_hz.
CoastCurve simulate_coastdown(const Plant<double>& plant, double speed_mps, double duration_s,
                              double rate_hz, double noise_mps, double correlation_s,
                              Random& random);

/// A drive that shows everything: thrust and steering change every `hold_s` to levels drawn from
/// the vehicle's limits, the two sides apart at times. `drive` seeds the commands alone.
struct DrivePlan {
  double duration_s = 60.0;
  double rate_hz = 100.0;
  double hold_s = 1.5;
  bool straight = false;  ///< no steering, both sides alike
  bool servo_measured = false;
  std::uint64_t drive = 1;
};
DrivingLog simulate_log(const Plant<double>& plant, const Vehicle& vehicle, const DrivePlan& plan,
                        const SensorNoise& noise, Random& random);

}  // namespace awmr
