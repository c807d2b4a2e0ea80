/// Parts of a scenario that act on the vehicle or its controller: disturbances, motor faults,
/// slippery ground, battery, sensors, actuators and options of the controller. All are off unless
/// the scenario sets them. Their random numbers are generated from seeds.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "awmr/control/guidance/waypoints.h"
#include "awmr/control/heading_lqi.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/model/allocation_form.h"
#include "awmr/model/parameters.h"

namespace awmr {

/// A force and a moment on the vehicle, in the body frame, over F_max.
template <class T>
struct BodyLoadOf {
  T surge = T(0.0);  ///< dimensionless, forward positive
  T sway = T(0.0);   ///< dimensionless, left positive
  T yaw_m = T(0.0);  ///< m, counter-clockwise positive
};
using BodyLoad = BodyLoadOf<double>;

/// Time window [from_s, to_s).
struct Window {
  double from_s = 0.0;  ///< start, >= 0
  /// End, > from_s, not included; infinity: to the end of the run.
  double to_s = std::numeric_limits<double>::infinity();
  bool holds(double t_s) const { return t_s >= from_s && t_s < to_s; }
};

/// One term of a disturbance, constant over each sample. Surge and sway: force over F_max, forward
/// and left positive; yaw: moment over F_max in m, counter-clockwise positive.
struct DisturbanceTerm {
  enum class Kind { kConstant, kSine, kNoise };
  Kind kind = Kind::kConstant;
  /// kConstant: the value, with its sign; kSine: the amplitude; kNoise: the standard deviation.
  double value = 0.0;
  Window window;                    ///< a step is a constant with from_s > 0
  double frequency_hz = 0.0;        ///< kSine: frequency, > 0
  std::optional<double> phase_rad;  ///< kSine: phase at t = 0; absent: drawn from the seed
  double bandwidth_hz = 0.0;        ///< kNoise: corner frequency of the first-order low pass, > 0
};

/// Uniform slope of the ground.
struct Slope {
  double angle_rad = 0.0;     ///< angle from the horizontal, rad, >= 0
  double downhill_rad = 0.0;  ///< rad: heading of the steepest descent in the world frame
};

/// External forces on the vehicle; the terms of an axis are added.
struct Disturbance {
  std::vector<DisturbanceTerm> surge;  ///< force over F_max, forward positive
  std::vector<DisturbanceTerm> sway;   ///< force over F_max, to the left positive
  std::vector<DisturbanceTerm> yaw;    ///< moment over F_max, m, counter-clockwise positive
  std::optional<Slope> slope;
  bool any() const { return slope || !surge.empty() || !sway.empty() || !yaw.empty(); }
};

/// The four wheels.
enum class Wheel { kFrontLeft, kFrontRight, kRearLeft, kRearRight };

/// Fault of motors, which make only a fraction of the requested force.
struct WheelFault {
  std::vector<Wheel> wheels;
  Window window;
  double share = 0.0;  ///< fraction of the requested force, [0, 1]; 0: the motors are dead
};

/// Slippery disc on the ground: the magnitude of the longitudinal force of a wheel on the disc is
/// at most `force_max`.
struct SlipperyPatch {
  Position<double> centre_m{};
  double radius_m = 0.0;   ///< > 0
  double force_max = 0.0;  ///< largest force of a wheel on the disc, over F_max, >= 0
};

/// Battery. Discharge: the largest command that takes effect at a motor decreases linearly from
/// `from_s` to `to_s`, to the fraction `share_end` of the largest command, and is then constant.
/// Sag: the voltage falls under the motors' current. The controller measures neither.
struct Battery {
  double from_s = 0.0;     ///< start of the decrease, >= 0
  double to_s = 1.0;       ///< end of the decrease, > from_s
  double share_end = 1.0;  ///< largest command at the end, over that at the start, [0, 1]
  /// Ratio of the internal resistance of the battery to that of the winding of one motor, >= 0. It
  /// is approximately the relative voltage drop when one motor is stalled. 0: no sag.
  double sag = 0.0;
};

/// Errors of one sensor, in the unit of its reading.
struct Channel {
  double noise = 0.0;      ///< >= 0: standard deviation
  double bias = 0.0;       ///< added to each reading; constant over a run
  double quantum = 0.0;    ///< >= 0: step of the reading; 0: none
  double latency_s = 0.0;  ///< >= 0: time from the measured state to the reading
  /// tau, s, >= 0: correlation time of the noise. Two readings t seconds apart have errors with the
  /// correlation exp(-t/tau); 0: independent errors.
  double correlation_s = 0.0;
};

/// Correlation exp(-t/tau) of two noise values of a sensor that are t = `apart_s` > 0 apart, with
/// tau = `correlation_s`; 0 if tau is 0.
inline double noise_correlation(double correlation_s, double apart_s) {
  return correlation_s > 0.0 ? std::exp(-apart_s / correlation_s) : 0.0;
}

/// A GPS receiver with its own rate and latency.
struct Gps {
  double rate_hz = 0.0;          ///< fixes per second, > 0
  double latency_s = 0.0;        ///< >= 0: time from taking a fix to its arrival
  Channel x, y;                  ///< errors of the fixes, m; latency_s is not used
  std::vector<Window> dropouts;  ///< fixes that are taken in these windows are lost
};

/// Sensors of the controller. A quantity without a sensor is measured exactly. Exception: if
/// `sway_measured` is false, the measured sway speed is 0, as on most real vehicles.
struct Sensors {
  Channel heading;            ///< rad
  Channel yaw_rate;           ///< rad/s
  Channel speed;              ///< m/s, surge
  bool sway_measured = true;  ///< false: the measured sway speed is 0
  bool speed_signed = true;   ///< false: the measured speed is |u|, as with a GPS
  std::optional<Gps> gps;     ///< absent: the true position
};

/// Resolution and lag of the actuators between the commands and the wheels.
struct Actuators {
  double steering_quantum_rad = 0.0;  ///< one step of the servo's pulse; 0: any angle
  int pwm_counts = 0;                 ///< PWM counts at the largest motor command; 0: not rounded
  /// Time constant of the first-order lag of the wheel forces, s, >= 0.
  double motor_time_constant_s = 0.0;
};

/// A parameter that is set to an end of its 95 % interval.
struct CornerParameter {
  ParameterId id{};
  bool high = true;  ///< the upper end, else the lower
};

/// Options of the simulated controller.
struct ControlOptions {
  CombinedSplit split = CombinedSplit::kRedistribute;  ///< combined mode at actuator limits
  struct Observer {
    double bandwidth_radps = 0.0;  ///< L of DisturbanceObserver, > 0
    double yaw_max_m = 0.0;  ///< largest estimated disturbance in yaw: moment over F_max, m, > 0
    double surge_max = 0.0;  ///< largest estimated disturbance in surge: force over F_max, > 0
    /// true: the observer uses the command after the limits. false: it uses the command before the
    /// limits; a saturated actuator then looks like a disturbance, and the estimate winds up.
    bool anti_windup = true;
  };
  std::optional<Observer> observer;
  std::optional<LqiWeights<double>> lqi;     ///< absent: the heading law is sliding mode
  std::optional<AllocationForm> allocation;  ///< absent: the form of the vehicle
};

}  // namespace awmr
