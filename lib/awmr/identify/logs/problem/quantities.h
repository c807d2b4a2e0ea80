/// Quantities that a log fit can estimate: parameters, delays, lags, command errors, biases.
/// Private to identify/.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/identify/logs/simulation/extra_forces.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/transform.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"

namespace awmr {

struct LogFitOptions;

/// One free quantity of a fit. The search changes its coordinate, which is the value or the
/// logarithm of the value.
struct FreeQuantity {
  /// Kinds of quantities. In the Jacobian of a fit, the columns of the quantities are in this
  /// order.
  enum class Kind {
    kParameter,  ///< a model parameter
    /// Delay of all commands, s; negative if their time stamps are late.
    kDelay,
    /// Additional delay of the steering command relative to the forces, s, for example the period
    /// of the servo's pulses. Negative if the time stamps of the steering command are late.
    kSteeringDelay,
    kMotorLag,  ///< time constant of the motors, s
    /// Time, s, in which a controller lets the magnitude of a motor's force rise (kForceFall: fall)
    /// by F_max (ramped_forces.h). 0: the force follows its command at once.
    kForceRise,
    kForceFall,
    kSteeringTrim,  ///< steering angle at a command of 0, rad; positive to the left
    /// Dead band b >= 0, rad, of the steering: the command c steers to the angle c - b sgn c, or to
    /// 0 if |c| < b.
    kSteeringDeadBand,
    /// Asymmetry e of the steering: angles to the left are 1 + e times the command (beyond the dead
    /// band), angles to the right 1 - e times.
    kSteeringAsymmetry,
    /// Curve k of the steering linkage: the command c (beyond the dead band) steers to
    ///
    ///     c (1 + k (c/d_max)^2),   d_max: steering stop of the vehicle file
    ///
    /// Small commands c steer to the angle c, unless the scale is estimated too.
    kSteeringCurve,
    /// Scale error q of the steering: the angles are 1 + q times those of the other errors of the
    /// linkage except the trim. Only in fits with an asymmetry or a curve, which do not determine
    /// the scale (widen_by_steering_scale() in steering_linkage.h).
    kSteeringScale,
    kServoRate,  ///< rate limit of the steering angle, rad/s, in place of that of the vehicle file
    /// Force imbalance e: the forces of the left motors are 1 - e times their commands, those of
    /// the right motors 1 + e times.
    kForceImbalance,
    /// Half of the difference D between the dead zones of the right and the left motors (commands
    /// without force, F'): F'0 + D on the right, F'0 - D on the left.
    kDeadZoneDifference,
    /// Exponent p of the wheel forces: the command F' gives the force |F'|^p sgn F' (times F_max).
    kForceExponent,
    /// Saturation of the wheel forces: the share L, in [0, 1), of the force that is lost at F'm,
    /// the largest command of the logs. With w = (|F'|/F'm)^n, the command F' gives the force
    ///
    ///     F'/(1 + s w)^(1/n),   s = (1 - L)^(-n) - 1
    ///
    /// (times F_max). Small forces are proportional to the command. Slipping tyres, current limits
    /// or a weak battery reduce large ones.
    kForceSaturation,
    kSaturationSharpness,  ///< n of the saturation: the larger n, the more sudden the limit
    /// Sag of the supply: the share L, in [0, 0.5], of both forces that is lost if both commands
    /// have the magnitude F'm, the largest command of the logs. The current of each motor lowers
    /// the voltage of the common battery. The commands F'_i give the forces
    ///
    ///     F'_i (1 - L (|F'_left| + |F'_right|)/(2 F'm))
    ///
    /// (times F_max).
    kSupplySag,
    /// Share k, in [0, 1], of the force of a motor with back-EMF that remains when its command
    /// becomes 0, and then decays with the lag of the motor, without back-EMF. 0: the force ends at
    /// once.
    kRunOn,
    /// Scale error e of the forces of one log: its wheel forces are 1 + e times their commands, for
    /// example because of a lower battery voltage than in the first log (log_terms.h).
    kForceScale,
    /// Scale error e of the resistance of one log, in surge (channel kSpeed) or yaw (kYawRate): it
    /// is 1 + e times that of the first log, for example on other ground (log_terms.h).
    kResistanceScale,
    kExtraForce,   ///< a force that the model does not contain (extra_forces.h)
    kBias,         ///< constant offset of a channel
    kSensorDelay,  ///< latency of a channel, s
    /// Time L, s, over which a speed or yaw rate is averaged: the reading is the mean of the last L
    /// seconds (before its latency), as if a program divided counts or an angle by L.
    kAveraging,
    kSensorLag,  ///< time constant of a low-pass filter of a channel, s
    /// Damping zeta of the low-pass filter of a channel, which this quantity makes a filter of
    /// second order (filtered_channel.h).
    kLagDamping,
    kSmoothing,    ///< variance of a symmetric kernel that smooths a channel, s^2
    kSensorScale,  ///< scale error s of a channel: it reads 1 + s times the true value
    kWheelSlip,    ///< slip of the wheels that measure a channel (wheel_slip.h)
    /// Mounting of the sensor of the sway speed v: its distance x_s, m, ahead of the centre of
    /// gravity, and (kSwayAngle) the angle a, rad, by which it is turned to the left. With the
    /// speed u and the yaw rate r, it reads
    ///
    ///     v cos a - u sin a + x_s r
    kSwayOffset,
    kSwayAngle,
    /// Distance y_s, m, of the sensor of the speed u to the left of the vehicle's centre line. r is
    /// the yaw rate. The sensor reads u - y_s r. For the speed of a left wheel, y_s is half of the
    /// track width; for a right wheel, minus half of it.
    kSpeedOffset,
    /// Place of the antenna or marker whose position x_m and y_m are: x_a, m, ahead of the centre
    /// of gravity (with kAxleOffset: of the middle of the axle), and (kPositionLeft) y_a, m, to the
    /// left of it. At the position (x, y) and the heading psi of the vehicle, the columns read
    ///
    ///     x + x_a cos psi - y_a sin psi,   y + x_a sin psi + y_a cos psi
    kPositionAhead,
    kPositionLeft,
    /// Deviation of a compass by magnetic parts of the vehicle: semicircular by permanent magnetism
    /// ("hard iron", B and C), quadrantal by induced magnetism ("soft iron", D and E). With the
    /// heading psi and these coefficients, rad (kCompassSin to kCompassCos2), it reads
    ///
    ///     psi + B sin psi + C cos psi + D sin 2 psi + E cos 2 psi
    kCompassSin,
    kCompassCos,
    kCompassSin2,
    kCompassCos2
  };
  Kind kind = Kind::kParameter;
  ParameterId id = ParameterId::kMassNorm;  ///< for kParameter
  /// Channel, for kinds of one channel; kX for the delay of x and y.
  LogChannel channel = LogChannel::kX;
  ExtraForce force = ExtraForce::kSlopeX;  ///< for kExtraForce
  /// Number of the only log in which this term acts (DrivingLog::number); 0: it acts in all logs.
  int log = 0;
  Scale scale = Scale::kLinear;
  /// Change of the coordinate that counts as large, by kind. Standard deviations of priors and
  /// limits of identifiability are multiples of it:
  ///   - 1 for a logarithm (a factor e), an exponent or a bias (SI);
  ///   - 0.2 for a term of a resistance family, Stribeck friction or drag in turns;
  ///   - 0.1 for a delay or lag (s), a trim or angle (rad), an imbalance, excess, saturation, wheel
  ///     slip or offset (m);
  ///   - 0.5 for a slope (m/s^2), 0.01 for smoothing (s^2).
  double large_change = 1.0;
  /// Largest command F'm of the logs, > 0 (for kForceSaturation and kSupplySag).
  double full_command = 1.0;
  double fastest = 1.0;  ///< largest speed of the logs, m/s or rad/s (for a Stribeck speed scale)
  bool is_at_rows = false;    ///< true: the filter makes one step per row of a log (for kSensorLag)
  bool is_mean = false;       ///< true: moving average; false: Gaussian kernel (for kSmoothing)
  bool turns_slowly = false;  ///< RampTimes::turns_slowly (for kForceRise)
  bool is_ratio = false;      ///< true: a slip ratio; false: a slip speed (for kWheelSlip)
  /// For errors of the steering (is_of_linkage()). True: the stop limits the command, so the angle
  /// may lie beyond the stop. False: the stop limits the angle.
  bool is_beyond_stop = false;

  bool acts_in(const DrivingLog& one) const { return log == 0 || log == one.number; }
  bool is(ParameterId parameter) const { return kind == Kind::kParameter && id == parameter; }
  bool is(ExtraForce one) const { return kind == Kind::kExtraForce && force == one; }
  bool is(Kind one) const { return kind == one && log == 0; }
  bool is(const std::string& one) const { return name() == one; }
  bool is_stribeck_speed() const {
    return is(ExtraForce::kSurgeStribeckSpeed) || is(ExtraForce::kYawStribeckSpeed);
  }
  /// True for Stribeck friction, its speed scales, and slopes, which no resistance family can
  /// describe.
  bool is_stribeck_or_slope() const {
    return kind == Kind::kExtraForce && force <= ExtraForce::kSlopeY;
  }
  bool is_turn_drag_exponent() const {
    return is(ExtraForce::kTurnDragExponent) || is(ExtraForce::kTurnDragSpeedExponent);
  }
  /// True for e_b or e_r of extra_forces.h, the excess of braking or backward forces. A fit
  /// contains at most one of the two.
  bool is_force_excess() const {
    return is(ExtraForce::kBrakeForce) || is(ExtraForce::kReverseForce);
  }
  /// True for a quantity that only describes the shape of another term: sharpness of a saturation,
  /// damping of a sensor's filter, speed scale of Stribeck friction, exponents of the drag in
  /// turns.
  bool is_form() const {
    return kind == Kind::kSaturationSharpness || kind == Kind::kLagDamping || is_stribeck_speed() ||
           is_turn_drag_exponent();
  }
  /// True for a time in which a controller lets forces rise or fall (ramped_forces.h).
  bool is_ramp() const { return kind == Kind::kForceRise || kind == Kind::kForceFall; }
  /// True for an error of the steering linkage, by which the angle differs from the command.
  bool is_of_linkage() const {
    return kind == Kind::kSteeringTrim || kind == Kind::kSteeringDeadBand ||
           kind == Kind::kSteeringAsymmetry || kind == Kind::kSteeringCurve ||
           kind == Kind::kSteeringScale;
  }
  /// True for a quantity that can be 0 but not negative. Its estimate may therefore lie at the
  /// lower end of its range.
  bool may_be_zero() const;
  std::string name() const;
  double value(double coordinate) const;
  double jacobian(double coordinate) const;  ///< d value / d coordinate
};

FreeQuantity free_parameter(ParameterId id);

/// Parameters to which the resistance of an axis is proportional. `axis`: kSpeed (surge) or
/// kYawRate.
std::array<ParameterId, 3> resistance_of(LogChannel axis);

/// A quantity of this kind, except those that need more than the channel (functions below).
/// `channel`: for kinds of one channel.
FreeQuantity free_term(FreeQuantity::Kind kind, LogChannel channel = LogChannel::kX);

/// Rate limit of the steering angle. `begin_radps`: initial guess, > 0.
FreeQuantity servo_rate(double begin_radps);

/// Saturation of the wheel forces. `full_command`: largest command F'm of the logs, > 0.
FreeQuantity force_saturation(double full_command);
inline constexpr double kDefaultSharpness = 4.0;  ///< n in fits that do not estimate it

/// Sag of the supply. `full_command`: as above.
FreeQuantity supply_sag(double full_command);

/// A force that the model does not contain (extra_forces.h), except the speed scale of Stribeck
/// friction: for that, call stribeck_speed_term().
FreeQuantity extra_force(ExtraForce force);

/// Time constant, s, of a low-pass filter of first order through which a channel was logged.
/// `is_at_rows`: true for a recursive filter with one step per row of the log, false for a
/// continuous filter (filtered_channel.h).
FreeQuantity sensor_lag_of(LogChannel channel, bool is_at_rows = false);

/// Variance, s^2, of a symmetric kernel that smoothed a channel over the rows of the log: by
/// central differences, interpolation between the rows of another log, or smoothing after the
/// drive. `is_mean`: true for a moving average, false for a Gaussian kernel (smoothing_kernel.h).
FreeQuantity smoothing_of(LogChannel channel, bool is_mean = false);

/// Shortest accepted time of a ramp of the forces, s. The effect of a faster ramp is like that of
/// commands that change between two rows, or of a motor's lag.
inline constexpr double kShortestRamp_s = 0.05;

/// Time in which the magnitude of a motor's force rises by F_max. `turns_slowly`: true if the fall
/// to 0 before a change of the sign is as slow (RampTimes).
FreeQuantity force_rise(bool turns_slowly);

/// Slip s of the wheels that measure the speed or the yaw rate (wheel_slip.h): a slip ratio if
/// `is_ratio`, else a slip speed.
FreeQuantity wheel_slip_of(LogChannel channel, bool is_ratio);

struct FreeTerm {
  FreeQuantity quantity;
  double begin;  ///< initial guess of its coordinate
};

/// Time constant T and damping zeta of a low-pass filter of second order through which a channel
/// was logged, for example zeta = 1 for two equal filters in series, 0.707 for a Butterworth
/// filter. `delay_s`: delay 2 zeta T of slow signals at the initial guess. `is_at_rows`: true for a
/// tracking filter with one step per row of the log, false for a continuous filter
/// (filtered_channel.h).
std::vector<FreeTerm> second_order_lag_of(LogChannel channel, double delay_s,
                                          bool is_at_rows = false);

/// True for a negative delay of the commands, which means that their time stamps are late.
bool is_late_commands(const FreeTerm& term);

/// True for slip of the wheels that measure a channel.
bool is_slip(const FreeTerm& term);

/// Speed scale w_s of the Stribeck friction `force`, with its initial guess. `fastest`: largest
/// speed of the logs, m/s or rad/s.
FreeTerm stribeck_speed_term(ExtraForce force, double fastest);
/// The force that remains after a command of 0 (kRunOn), beginning with a share of one half.
FreeTerm run_on_term();
inline constexpr double kStribeckShare = 0.1;  ///< initial guess of w_s over `fastest`

/// Index of the first quantity that is `what`: a ParameterId, an ExtraForce, a Kind (acting in all
/// logs) or a name.
/// Empty if there is none.
template <class What>
std::optional<std::size_t> place_of(const std::vector<FreeQuantity>& quantities, What what) {
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (quantities[i].is(what)) return i;
  }
  return std::nullopt;
}
template <class What>
bool has(const std::vector<FreeQuantity>& quantities, What what) {
  return place_of(quantities, what).has_value();
}
bool has_kind(const std::vector<FreeQuantity>& quantities, FreeQuantity::Kind kind,
              LogChannel channel);
bool has_force_excess(const std::vector<FreeQuantity>& quantities);

/// Free quantities of a fit, in the order of FreeQuantity::Kind.
std::vector<FreeQuantity> free_quantities(const LogFitOptions& options);

/// One per quantity: coordinate of its initial guess; 0 for a bias.
std::vector<double> initial_coordinates(const LogFitOptions& options);

/// One per quantity: bounds of its coordinate. `initial`: coordinates of the initial guess.
std::vector<Interval> coordinate_bounds(const std::vector<FreeQuantity>& quantities,
                                        const std::vector<double>& initial, const Vehicle& vehicle);

/// Returns the values of all parameters: free ones at these coordinates, others from `held`.
ParameterValues<double> parameters_at(ParameterValues<double> held,
                                      const std::vector<FreeQuantity>& quantities,
                                      const std::vector<double>& coordinates);

}  // namespace awmr
