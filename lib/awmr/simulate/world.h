/// Parts of a scenario that act on the vehicle or its controller: disturbances, motor faults,
/// slippery ground, battery, sensors, actuators and options of the controller. A part that the
/// scenario does not set has no effect. Random numbers follow from seeds, so they are reproducible.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "awmr/control/guidance/waypoints.h"
#include "awmr/control/heading_lqi.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/model/allocation_form.h"
#include "awmr/model/gains.h"
#include "awmr/model/parameters.h"

namespace awmr {

/// A force and a moment on the vehicle, in the body frame, divided by F_max.
template <class T>
struct BodyLoadOf {
  T surge = T(0.0);  ///< surge force, dimensionless, forward positive
  T sway = T(0.0);   ///< dimensionless, left positive
  T yaw_m = T(0.0);  ///< m, counter-clockwise positive
};
using BodyLoad = BodyLoadOf<double>;

/// Time window [from_s, to_s).
struct Window {
  double from_s = 0.0;  ///< start, >= 0
  /// End of the window, > from_s; the end itself is outside. Infinity: the end of the run.
  double to_s = std::numeric_limits<double>::infinity();
  bool holds(double t_s) const { return t_s >= from_s && t_s < to_s; }
};

/// One term of a disturbance, constant over each sample. Surge and sway: a force divided by F_max,
/// positive forward and to the left. Yaw: a moment divided by F_max, m, counter-clockwise positive.
struct DisturbanceTerm {
  enum class Kind { kConstant, kSine, kNoise };
  Kind kind = Kind::kConstant;
  /// kConstant: the value, with its sign; kSine: the amplitude; kNoise: the standard deviation.
  double value = 0.0;
  /// time in which the term acts; a step is a constant with from_s > 0
  Window window;
  double frequency_hz = 0.0;        ///< kSine: frequency, > 0
  std::optional<double> phase_rad;  ///< kSine: phase at t = 0; absent: drawn from the seed
  double bandwidth_hz = 0.0;        ///< kNoise: corner frequency of its first-order low pass, > 0
};

/// Uniform slope of the ground.
struct Slope {
  double angle_rad = 0.0;     ///< angle from the horizontal, rad, >= 0
  double downhill_rad = 0.0;  ///< heading of the steepest descent, rad, in the world frame
};

/// External forces on the vehicle. The terms of each axis are added.
struct Disturbance {
  std::vector<DisturbanceTerm> surge;  ///< force divided by F_max, forward positive
  std::vector<DisturbanceTerm> sway;   ///< force divided by F_max, to the left positive
  std::vector<DisturbanceTerm> yaw;    ///< moment divided by F_max, m, counter-clockwise positive
  std::optional<Slope> slope;
  bool any() const { return slope || !surge.empty() || !sway.empty() || !yaw.empty(); }
};

/// The four wheels.
enum class Wheel { kFrontLeft, kFrontRight, kRearLeft, kRearRight };

/// Fault of one or several motors: they make only a fraction of the requested force.
struct WheelFault {
  std::vector<Wheel> wheels;
  Window window;
  double share = 0.0;  ///< remaining fraction of the force, [0, 1]; 0: no force
};

/// Slippery disc on the ground: the magnitude of the longitudinal force of a wheel on the disc is
/// at most `force_max`.
struct SlipperyPatch {
  Position<double> centre_m{};
  double radius_m = 0.0;   ///< > 0
  double force_max = 0.0;  ///< largest force of a wheel on the disc, divided by F_max, >= 0
};

/// Battery with falling voltage, which the controller does not measure. Discharge: from `from_s` to
/// `to_s`, the largest possible motor command falls linearly to the fraction `share_end`, and then
/// stays constant. Sag: the voltage drops while the motors draw current.
struct Battery {
  double from_s = 0.0;  ///< start of the decrease, >= 0
  double to_s = 1.0;    ///< end of the decrease, > from_s
  /// largest motor command at the end, divided by that at the start, [0, 1]
  double share_end = 1.0;
  /// Internal resistance of the battery divided by the winding resistance of one motor, >= 0. It is
  /// about the relative voltage drop when one motor is stalled. 0: no sag.
  double sag = 0.0;
};

/// Errors of one sensor, in the unit of its readings.
struct Channel {
  double noise = 0.0;      ///< >= 0: standard deviation
  double bias = 0.0;       ///< constant error that is added to each reading
  double quantum = 0.0;    ///< >= 0: resolution, step between two readings; 0: exact
  double latency_s = 0.0;  ///< >= 0: age of the measured state at the reading
  /// tau, s, >= 0: correlation time of the noise. The errors of two readings t seconds apart have
  /// the correlation exp(-t/tau). 0: the errors are independent.
  double correlation_s = 0.0;
};

/// Correlation exp(-t/tau) of two noise values of a sensor, taken at times t = `apart_s` > 0 apart.
/// tau is `correlation_s`; if it is 0, the result is 0.
inline double noise_correlation(double correlation_s, double apart_s) {
  return correlation_s > 0.0 ? std::exp(-apart_s / correlation_s) : 0.0;
}

/// A GPS receiver with its own rate and latency.
struct Gps {
  double rate_hz = 0.0;          ///< fixes per second, > 0
  double latency_s = 0.0;        ///< >= 0: time from the measurement of a fix to its arrival
  Channel x, y;                  ///< errors of the fixes, m; the member latency_s is not used
  std::vector<Window> dropouts;  ///< fixes measured in these windows of time are lost
};

/// Sensors of the controller. A quantity without a sensor is measured exactly, except the sway
/// speed: if `sway_measured` is false, it reads 0, because most real vehicles cannot measure it.
struct Sensors {
  Channel heading;            ///< rad
  Channel yaw_rate;           ///< rad/s
  Channel speed;              ///< m/s, surge
  bool sway_measured = true;  ///< false: the measured sway speed is 0
  bool speed_signed = true;   ///< false: only the magnitude |u| is measured, as by a GPS
  std::optional<Gps> gps;     ///< absent: the true position
};

/// Resolution of the commands to servo and motors, and lag of the motors.
struct Actuators {
  double steering_quantum_rad = 0.0;  ///< resolution of the servo, rad; 0: exact
  int pwm_counts = 0;                 ///< PWM counts of the largest motor command; 0: exact
  /// Time constant of the first-order lag of the wheel forces, s, >= 0.
  double motor_time_constant_s = 0.0;
};

/// A parameter of the plant that is set to an end of its 95 % interval.
struct CornerParameter {
  ParameterId id{};
  bool high = true;  ///< the upper end, else the lower
};

/// Options of the simulated controller.
struct ControlOptions {
  /// how combined mode distributes the moment at limits
  CombinedSplit split = CombinedSplit::kRedistribute;
  /// disturbance observer with bandwidth > 0; absent: that of the gains
  std::optional<ObserverGains<double>> observer;
  /// true: the observer gets the commands after the limits. false: before the limits; a saturated
  /// actuator then looks like a disturbance, and the estimate grows without reason (wind-up).
  bool anti_windup = true;
  std::optional<LqiWeights<double>> lqi;  ///< LQI heading law; absent: the sliding mode
  /// form of the allocation; absent: that of the vehicle
  std::optional<AllocationForm> allocation;
};

}  // namespace awmr
