// Checks of a log for wrong units of times, forces and steering angles (log_consistency.h).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "awmr/core/containers.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/trials/checks/channel_quality.h"
#include "awmr/trials/checks/log_evidence.h"
#include "force_units.h"

namespace awmr {
namespace {

/// Builds the contradiction which states that t_s is probably in `unit`, not in seconds.
Contradiction time_in(const UnitFactor& unit, const Evidence& evidence) {
  const double step_s = evidence.log.median_step_s();
  const double sample_time_s = evidence.vehicle.sample_time_s;
  return {"t_s",
          fmt::format("rows are {:.4g} apart in t_s, {:.3g} times sample_time_s = {:g} s: the time "
                      "looks like {}",
                      step_s, step_s / sample_time_s, sample_time_s, unit.words),
          scaled_mapping(evidence, "t_s", 1.0 / unit.factor)};
}

std::optional<Contradiction> check_time(const Evidence& evidence) {
  static constexpr std::array<UnitFactor, 3> kFactors{
      {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}}};
  const double step_s = evidence.log.median_step_s();
  const double ratio = step_s / evidence.vehicle.sample_time_s;
  for (const UnitFactor& unit : kFactors) {
    if (ratio < 0.3 * unit.factor || ratio > 30.0 * unit.factor) continue;
    return time_in(unit, evidence);
  }
  // A row spacing below 1 ms and below a twentieth of the sample time is too short for a t_s in
  // seconds.
  constexpr double kFastest_s = 1e-3;
  constexpr double kOften = 0.05;
  if (step_s >= kFastest_s || ratio >= kOften) return std::nullopt;
  static constexpr std::array<UnitFactor, 4> kLong{{{1.0 / 60.0, "minutes"},
                                                    {1e-3, "thousands of seconds"},
                                                    {1.0 / 3600.0, "hours"},
                                                    {1.0 / 86400.0, "days"}}};
  const UnitFactor& nearest = *std::ranges::min_element(
      kLong, {}, [&](const UnitFactor& one) { return std::abs(std::log(ratio / one.factor)); });
  return time_in(nearest, evidence);
}

std::optional<Contradiction> check_force(const Evidence& evidence, std::string_view column,
                                         const std::vector<double>& values,
                                         const ForceSpan& of_both) {
  const Interval& limit = evidence.vehicle.wheel_force;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double above = limit.hi * kForceRounding;
  const double below = limit.lo < 0.0 ? limit.lo * kForceRounding : -0.01 * limit.hi;
  if (*most <= above && *least >= below) return std::nullopt;
  const double worst = *most > above ? *most : *least;
  const std::string beyond = fmt::format(
      "reaches {:.4g}, beyond wheel_force [{:g}, {:g}] of the "
      "vehicle: ",
      worst, limit.lo, limit.hi);
  if (of_both.largest <= largest_wheel_force(evidence.vehicle) * kForceRounding) {
    // The vehicle allows this magnitude in the opposite direction, so only the sign is wrong, not
    // the unit.
    return Contradiction{
        std::string(column),
        beyond + "the vehicle permits a force of this size only in the opposite direction", "",
        fmt::format("widen wheel_force in vehicle.json to {:.4g}, or correct the signs", worst)};
  }
  const ForceUnits units = force_units(of_both, evidence.vehicle);
  const std::vector<UnitFix> unit_fixes = force_unit_fixes(units, column);
  const std::string likeliest =
      unit_fixes.empty()
          ? ""
          : scaled_mapping(evidence, column, unit_fixes[0].factor, unit_fixes[0].offset);
  std::string words = beyond + words_of(units);
  if (unit_fixes.empty()) {
    words += fmt::format(", or like commands before the controller limits them (map them with {})",
                         option_text(fmt::format("column '{0}=min({1:g}, max({2:g}, {0}))'", column,
                                                 limit.hi, limit.lo)));
  }
  return Contradiction{std::string(column), words, likeliest,
                       remedy_of(units, unit_fixes, evidence.mappings)};
}

/// Range of the forces of both sides without zeros, because 0 in a column of servo pulses means
/// that there was no reading.
ForceSpan force_span(const DrivingLog& log) {
  ForceSpan span{std::numeric_limits<double>::infinity(), 0.0};
  for (const auto* values : {&log.force_left, &log.force_right}) {
    for (const double value : *values) {
      if (value != 0.0) span = joined(span, {value, std::abs(value)});
    }
  }
  return span;
}

std::vector<Contradiction> check_forces(const Evidence& evidence) {
  const ForceSpan span = force_span(evidence.log);
  std::vector<Contradiction> found;
  for (const auto& [column, values] : {std::pair{"force_left", &evidence.log.force_left},
                                       std::pair{"force_right", &evidence.log.force_right}}) {
    if (auto one = check_force(evidence, column, *values, span)) found.push_back(*one);
  }
  return found;
}

/// Ratio of the path's curvature, r/u, to the curvature for the steering angle, tan(`factor`
/// d_r)/l_f. r is the yaw rate and u the speed; d_r is the logged angle, l_f the distance from the
/// centre of gravity to the front axle. The ratio is at most about 1 if `factor` d_r is the true
/// angle in rad. Skips windows in which the force difference turns the vehicle more than the
/// steering. Empty without a speed, without heading and yaw rate, or if the two curvatures are not
/// proportional.
std::optional<double> sharpness(const Evidence& evidence, double factor) {
  const bool heading = evidence.has(LogChannel::kHeading);
  if (!evidence.has(LogChannel::kSpeed)) return std::nullopt;
  if (!heading && !evidence.has(LogChannel::kYawRate)) return std::nullopt;
  std::vector<double> pointed;
  std::vector<double> turned;
  for (const EvidenceWindow& w : evidence.overlapping) {
    if (std::abs(w.tau_diff_m) > factor * std::abs(w.tau_steering_m)) continue;
    pointed.push_back(std::tan(factor * w.steering_rad) * w.driven_m /
                      evidence.vehicle.front_axle_m);
    turned.push_back(heading ? w.turned_rad : w.rate_rad);
  }
  const auto ratio = robust_ratio(pointed, turned);
  if (!ratio) return std::nullopt;
  return std::abs(*ratio);
}

double largest_steering_deg(const DrivingLog& log) {
  return degrees(largest_size(log.driving_steering_rad()));
}

/// Detects a servo command in place of the steering angle: a servo angle with its centre at 90 or
/// 180 deg, a pulse length in us, or percent of the stop.
std::optional<Contradiction> check_servo(const Evidence& evidence, const std::string& column) {
  const std::vector<double>& angle_rad = evidence.log.driving_steering_rad();
  const auto [low_rad, high_rad] = std::ranges::minmax_element(angle_rad);
  const double low = degrees(*low_rad);
  const double high = degrees(*high_rad);
  const double stop_deg = evidence.vehicle.steering_max_deg;
  const std::string reads = fmt::format(
      "goes from {:.4g} to {:.4g} deg, while the stop is at {:g} deg", low, high, stop_deg);
  // Servo angles may differ from the centre by up to this multiple of the stop, because calibration
  // and trim may move both ends slightly beyond the stop.
  constexpr double kBeyondStop = 1.2;
  for (const double centre : {90.0, 180.0}) {
    if (low < centre - kBeyondStop * stop_deg || high > centre + kBeyondStop * stop_deg) continue;
    return Contradiction{
        column, reads + fmt::format(": it looks like a servo's angle, {:g} straight ahead", centre),
        scaled_mapping(evidence, column, 1.0, -centre)};
  }
  if (kPulse_us.contains(low) && kPulse_us.contains(high)) {
    const double factor = stop_deg / 500.0;
    return Contradiction{column,
                         reads +
                             ": it looks like a servo's pulse length in us, 1500 straight ahead, "
                             "1000 and 2000 at the stops",
                         scaled_mapping(evidence, column, factor, -1500.0 * factor)};
  }
  const double most = std::max(std::abs(low), std::abs(high));
  if (most > 3.0 * stop_deg && std::abs(most / 100.0 - 1.0) <= 0.005) {
    return Contradiction{column, reads + ": it looks like percent of the stop",
                         scaled_mapping(evidence, column, stop_deg / 100.0)};
  }
  return std::nullopt;
}

std::optional<Contradiction> check_absent_steering(const Evidence& evidence) {
  const double largest_deg = largest_steering_deg(evidence.log);
  if (!(largest_deg > 0.0)) return std::nullopt;
  const std::string column(evidence.log.steering_column());
  return Contradiction{column,
                       fmt::format("reaches {:.4g} deg, but the vehicle's drive is "
                                   "\"differential\", which has no steering",
                                   largest_deg),
                       column + "=0"};
}

/// Detects steering angles far beyond the stop: probably the command or the counts of a servo.
std::optional<Contradiction> check_large_angles(const Evidence& evidence, const std::string& column,
                                                double largest_deg) {
  const double stop_deg = evidence.vehicle.steering_max_deg;
  if (largest_deg > 1.5 * stop_deg) {
    if (auto servo = check_servo(evidence, column)) return servo;
  }
  if (largest_deg <= 3.0 * stop_deg) return std::nullopt;
  return Contradiction{
      column,
      fmt::format(
          "reaches {:.4g} deg, while the stop is at {:g} deg: it looks like counts of a servo",
          largest_deg, stop_deg),
      "",
      fmt::format(
          "map it with {}",
          option_text(fmt::format("column '{}=(COUNTS - CENTRE)*DEGREES_PER_COUNT'", column)))};
}

/// Ratio of the path's curvature to that of the logged steering angle. In a log without a speed:
/// the yaw rate per moment of the steering, divided by the yaw rate per moment of a force
/// difference. Either ratio is about 1 if the angle was logged in degrees, and large if it was
/// logged in radians. Returns 0 if the log does not determine the ratio.
double times_as_sharp(const Evidence& evidence) {
  const double degree = degrees(1.0);
  if (const auto sharp = sharpness(evidence, degree)) return *sharp * degree;
  const MomentShares shares = moment_shares(
      evidence.windows, evidence.has(LogChannel::kHeading)
                            ? [](const EvidenceWindow& w) { return w.turned_rad; }
                            : [](const EvidenceWindow& w) { return w.rate_rad; });
  return shares.sides != 0.0 ? std::abs(shares.steering / shares.sides) : 0.0;
}

/// Detects angles in radians that are read as degrees. The largest angle is then at most 2.5 % of
/// the stop (pi/180 is 1.7 %), and the vehicle turns about 57 times as sharply as the angle allows.
/// The check requires at least 8 times.
std::optional<Contradiction> check_radians(const Evidence& evidence, const std::string& column,
                                           double largest_deg) {
  constexpr double kImpossible = 8.0;
  const double stop_deg = evidence.vehicle.steering_max_deg;
  if (largest_deg > 0.025 * stop_deg) return std::nullopt;
  const double times = times_as_sharp(evidence);
  if (times < kImpossible) return std::nullopt;
  return Contradiction{
      column,
      fmt::format("the vehicle turns {:.3g} times as sharply as this steering angle allows, and "
                  "the largest angle is {:.3g} % of the stop: the angle looks like radians",
                  times, 100.0 * largest_deg / stop_deg),
      scaled_mapping(evidence, column, degrees(1.0))};
}

/// Detects values that are not steering angles in degrees, and angles of a vehicle without
/// steering.
std::optional<Contradiction> check_steering(const Evidence& evidence) {
  if (!evidence.vehicle.has_steering()) return check_absent_steering(evidence);
  const double largest_deg = largest_steering_deg(evidence.log);
  const std::string column(evidence.log.steering_column());
  if (auto large = check_large_angles(evidence, column, largest_deg)) return large;
  return check_radians(evidence, column, largest_deg);
}

}  // namespace

std::vector<Contradiction> unit_contradictions(const Evidence& evidence) {
  std::vector<Contradiction> found = check_forces(evidence);
  // If the unit of t_s is wrong, the windows are not one second long, and the checks of the
  // motion's units fail.
  if (auto time = check_time(evidence)) {
    found.insert(found.begin(), *time);
    return found;
  }
  if (const auto steering = check_steering(evidence)) found.push_back(*steering);
  append(found, motion_unit_contradictions(evidence));
  return found;
}

}  // namespace awmr
