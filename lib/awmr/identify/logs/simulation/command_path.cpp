#include "awmr/identify/logs/simulation/command_path.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"
#include "awmr/model/scalar_math.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

HeldCommand logged_command(const DrivingLog& log, const ActingRows& rows) {
  return {{log.force_left[rows.forces], log.force_right[rows.forces]},
          log.driving_steering_rad()[rows.steering]};
}

/// Multiplies the derivatives of the force f of one side by `slope`, the derivative of the function
/// by which f was replaced (chain rule).
void scale_derivatives(double slope, double SideForces<double>::*side, DelayedCommand& at) {
  for (HeldCommand& by : at.by.of_kind) by.force.*side *= slope;
}

/// Replaces the forces f by the saturated forces f_s, and the derivatives of f with respect to the
/// columns of the fit by those of f_s. L: share of the force that is lost at the largest command
/// F'm of the logs; n: sharpness of the saturation. With w = (|f|/F'm)^n and s = (1 - L)^(-n) - 1:
///
///     f_s = f (1 + s w)^(-1/n)
///     d f_s/d f = (1 + s w)^(-1/n - 1),   d f_s/d s = -f w/n d f_s/d f
///     d f_s/d L = d f_s/d s n (1 + s)/(1 - L)
///     d f_s/d ln n = f_s (ln(1 + s w) - s w ln(w)/(1 + s w))/n - d f_s/d s n (1 + s) ln(1 - L)
void saturate(const CommandPath& path, DelayedCommand& at) {
  const double rest = 1.0 - path.terms.value(Kind::kForceSaturation);  // 1 - L
  const double n = path.terms.value(Kind::kSaturationSharpness, kDefaultSharpness);
  const double s = std::pow(rest, -n) - 1.0;
  for (double SideForces<double>::*const side :
       {&SideForces<double>::left, &SideForces<double>::right}) {
    double& force = at.command.force.*side;
    const double w = std::pow(std::abs(force) / path.full_command, n);
    const double sum = 1.0 + s * w;
    const double share = std::pow(sum, -1.0 / n);
    const double slope = share / sum;
    const double log_w = w > 0.0 ? std::log(w) : 0.0;
    const double by_s = -force * w * slope / n;
    scale_derivatives(slope, side, at);
    at.by[Kind::kForceSaturation].force.*side = by_s * n * (1.0 + s) / rest;
    at.by[Kind::kSaturationSharpness].force.*side =
        force * share * (std::log(sum) - s * w * log_w / sum) / n -
        by_s * n * (1.0 + s) * std::log(rest);
    force *= share;
  }
}

/// Replaces the forces f by |f|^p sgn f with the fitted exponent p. Computes the derivatives with
/// respect to the columns of the fit from the derivatives of |f|^p sgn f:
///
///     d/df = p |f|^(p - 1),   d/d ln p = p ln|f| |f|^p sgn f
void raise_to_power(const CommandPath& path, DelayedCommand& at) {
  const double p = path.terms.value(Kind::kForceExponent);
  for (double SideForces<double>::*const side :
       {&SideForces<double>::left, &SideForces<double>::right}) {
    double& force = at.command.force.*side;
    if (force == 0.0) continue;
    const double share = std::pow(std::abs(force), p - 1.0);
    scale_derivatives(p * share, side, at);
    at.by[Kind::kForceExponent].force.*side = p * std::log(std::abs(force)) * force * share;
    force *= share;
  }
}

/// Replaces the forces f_i by those of a sagging supply, and their derivatives by the chain rule.
/// With the sag L, the sum S = |f_left| + |f_right| and k = L/(2 F'm):
///
///     f_i (1 - k S),   d[f_i (1 - k S)] = (1 - k S) df_i - k f_i dS,   d/dL = -f_i S/(2 F'm)
void sag(const CommandPath& path, DelayedCommand& at) {
  const SideForces<double> f = at.command.force;
  const auto sign = [](double force) { return force == 0.0 ? 0.0 : std::copysign(1.0, force); };
  const double sum = std::abs(f.left) + std::abs(f.right);
  const double k = path.terms.value(Kind::kSupplySag) / (2.0 * path.full_command);
  for (HeldCommand& by : at.by.of_kind) {
    const double by_sum = sign(f.left) * by.force.left + sign(f.right) * by.force.right;
    by.force.left = (1.0 - k * sum) * by.force.left - k * f.left * by_sum;
    by.force.right = (1.0 - k * sum) * by.force.right - k * f.right * by_sum;
  }
  const double by_sag = -sum / (2.0 * path.full_command);
  at.by[Kind::kSupplySag].force = {by_sag * f.left, by_sag * f.right};
  at.command.force = {(1.0 - k * sum) * f.left, (1.0 - k * sum) * f.right};
}

/// Multiplies the forces by 1 + e, with the scale error e of the log.
void scale_forces(double e, DelayedCommand& at) {
  SideForces<double>& force = at.command.force;
  scale_derivatives(1.0 + e, &SideForces<double>::left, at);
  scale_derivatives(1.0 + e, &SideForces<double>::right, at);
  at.by[Kind::kForceScale].force = force;
  force = {(1.0 + e) * force.left, (1.0 + e) * force.right};
}

/// Multiplies the forces by 1 - e (left) and 1 + e (right), with the imbalance e.
void unbalance(double e, DelayedCommand& at) {
  SideForces<double>& force = at.command.force;
  scale_derivatives(1.0 - e, &SideForces<double>::left, at);
  scale_derivatives(1.0 + e, &SideForces<double>::right, at);
  at.by[Kind::kForceImbalance].force = {-force.left, force.right};
  force.left *= 1.0 - e;
  force.right *= 1.0 + e;
}

/// Adds D sgn F' to the left force and subtracts it from the right one, which does not change the
/// sign of a force. Behind the common dead zone F'0 of the plant, the dead zones are then F'0 - D
/// (left) and F'0 + D (right).
void shift_dead_zones(double difference, DelayedCommand& at) {
  const auto shift = [&](double SideForces<double>::*side, double by) {
    double& force = at.command.force.*side;
    const double sign = force == 0.0 ? 0.0 : std::copysign(1.0, force);
    if (std::abs(force) + by * difference > 0.0) {
      at.by[Kind::kDeadZoneDifference].force.*side = by * sign;
      force += by * difference * sign;
    } else {
      scale_derivatives(0.0, side, at);
      force = 0.0;
    }
  };
  shift(&SideForces<double>::left, 1.0);
  shift(&SideForces<double>::right, -1.0);
}

/// Replaces the steering command c by the angle to which the linkage steers, and the derivatives of
/// c with respect to the columns of the fit by those of the angle. b: dead band; e: asymmetry; k:
/// curve; q: scale error; d_max: steering stop. With s = sgn c and the part of the command beyond
/// the dead band, c_b = c - s b (0 if |c| < b), the angle is
///
///     (1 + q) (1 + s e) c_b (1 + k (c_b/d_max)^2)
void steer_by_linkage(const CommandPath& path, DelayedCommand& at) {
  const double band_rad = path.terms.value(Kind::kSteeringDeadBand);
  const double e = path.terms.value(Kind::kSteeringAsymmetry);
  const double k = path.terms.value(Kind::kSteeringCurve);
  const double scale = 1.0 + path.terms.value(Kind::kSteeringScale);
  double& angle_rad = at.command.steering_rad;
  const bool moves = std::abs(angle_rad) > band_rad;
  const double side = std::copysign(moves ? 1.0 : 0.0, angle_rad);
  const double beyond_rad = moves ? angle_rad - side * band_rad : 0.0;
  const double share = 1.0 + side * e;
  const double square = std::pow(beyond_rad / path.steering_stop_rad, 2);
  const double curve = 1.0 + k * square;
  const double unscaled_rad = beyond_rad * share * curve;
  at.by[Kind::kSteeringDeadBand].steering_rad = -side * scale * share * (1.0 + 3.0 * k * square);
  at.by[Kind::kSteeringAsymmetry].steering_rad = scale * std::abs(beyond_rad) * curve;
  at.by[Kind::kSteeringCurve].steering_rad = scale * beyond_rad * share * square;
  at.by[Kind::kSteeringScale].steering_rad = unscaled_rad;
  angle_rad = scale * unscaled_rad;
}

/// Applies the constant errors of the commands in this order: stop of the command (if
/// CommandPath::stop_limits_command), dead band, asymmetry, curve and scale of the
/// linkage, trim, scale of the forces, imbalance, exponent, saturation, sag of the supply,
/// difference of the dead zones.
DelayedCommand with_errors(DelayedCommand at, const CommandPath& path) {
  const CommandTerms& terms = path.terms;
  double& steering_rad = at.command.steering_rad;
  if (path.stop_limits_command) {
    steering_rad = math::saturate(steering_rad, path.steering_stop_rad);
  }
  if (terms[Kind::kSteeringDeadBand] || terms[Kind::kSteeringAsymmetry] ||
      terms[Kind::kSteeringCurve] || terms[Kind::kSteeringScale]) {
    steer_by_linkage(path, at);
  }
  if (terms[Kind::kSteeringTrim]) {
    steering_rad += terms.value(Kind::kSteeringTrim);
    at.by[Kind::kSteeringTrim].steering_rad = 1.0;
  }
  if (terms[Kind::kForceScale]) scale_forces(terms.value(Kind::kForceScale), at);
  if (terms[Kind::kForceImbalance]) unbalance(terms.value(Kind::kForceImbalance), at);
  if (terms[Kind::kForceExponent]) raise_to_power(path, at);
  if (terms[Kind::kForceSaturation]) saturate(path, at);
  if (terms[Kind::kSupplySag]) sag(path, at);
  if (terms[Kind::kDeadZoneDifference]) {
    shift_dead_zones(terms.value(Kind::kDeadZoneDifference), at);
  }
  return at;
}

/// For each side whose command is 0, multiplies the force and its derivatives with respect to the
/// columns by the share that remains (kRunOn), if the motors switch off
/// (CommandPath::switches_off).
void switch_off(const SideForces<double>& command, const CommandPath& path,
                DelayedCommand& at_wheels) {
  const double share = path.terms.value(Kind::kRunOn);
  const auto off = [&](double SideForces<double>::*side, bool SideForces<bool>::*is_off) {
    if (command.*side != 0.0) return;
    at_wheels.command.is_off.*is_off = true;
    double& force = at_wheels.command.force.*side;
    scale_derivatives(share, side, at_wheels);
    at_wheels.by[Kind::kRunOn].force.*side = force;
    force *= share;
  };
  off(&SideForces<double>::left, &SideForces<bool>::left);
  off(&SideForces<double>::right, &SideForces<bool>::right);
}

}  // namespace

std::optional<std::size_t> CommandPath::change_column(std::size_t row) const {
  const auto found = std::ranges::lower_bound(changes, row, {}, &UncertainChange::row);
  if (found == changes.end() || found->row != row) return std::nullopt;
  return first_change_column + at(found - changes.begin());
}

std::optional<std::size_t> CommandPath::last_change_column(std::size_t row) const {
  const auto next = std::ranges::upper_bound(changes, row, {}, &UncertainChange::row);
  if (next == changes.begin()) return std::nullopt;
  return first_change_column + at(next - changes.begin()) - 1;
}

DelayedCommand command_of_rows(const DrivingLog& log, const ActingRows& rows,
                               const CommandPath& path) {
  return with_errors({logged_command(log, rows)}, path);
}

namespace {

/// Sets the mean forces over [t, t + h] and their derivatives, with the motors' lag or ramps.
void set_mean_forces(const LogSignals& signals, double t_s, double h_s, const CommandPath& path,
                     DelayedCommand& at) {
  if (path.ramps) {
    const RampedForces::Mean mean = path.ramps->mean(t_s, h_s, path.force_delay_s());
    at.command.force = mean.force;
    at.by[Kind::kMotorLag].force = mean.by_lag;
    at.by[Kind::kDelay].force = mean.by_delay;
    at.by[Kind::kForceRise].force = mean.by_rise;
    at.by[Kind::kForceFall].force = mean.by_fall;
    return;
  }
  const LaggedForces::Mean mean = path.lag->mean(signals, t_s, h_s, path.force_delay_s());
  at.command.force = mean.force;
  at.by[Kind::kMotorLag].force = mean.by_lag;
  at.by[Kind::kDelay].force = mean.by_delay;
}

}  // namespace

DelayedCommand command_over(const LogSignals& signals, const ActingRows& rows, double t_s,
                            double h_s, const CommandPath& path) {
  if (!path.has_mean_forces()) return command_of_rows(*signals.log, rows, path);
  const HeldCommand logged = logged_command(*signals.log, rows);
  DelayedCommand at{logged};
  set_mean_forces(signals, t_s, h_s, path, at);
  at.change_column = path.last_change_column(rows.forces);
  if (path.switches_off) switch_off(logged.force, path, at);
  return with_errors(at, path);
}

DelayedCommand command_at(const LogSignals& signals, double t_s, const CommandPath& path) {
  constexpr double kMoment_s = 1e-6;
  const auto row_at = [&](double at_s) {
    return ActingRow(signals.log->t_s, at_s + 2.0 * kSameTime_s).row();
  };
  DelayedCommand at = command_over(
      signals, {row_at(t_s - path.force_delay_s()), row_at(t_s - path.steering_delay_s())}, t_s,
      kMoment_s, path);
  // Without a ramp, the derivative with respect to its time is an impulse, which has no value at
  // one time.
  for (const Kind ramp : {Kind::kForceRise, Kind::kForceFall}) {
    if (path.terms.value(ramp) == 0.0) at.by[ramp] = {};
  }
  return at;
}

}  // namespace awmr
