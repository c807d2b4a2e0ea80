#include "steering_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/trials/robust_ratio.h"
#include "force_units.h"

namespace awmr {
namespace {

/// Ratio of the curvature of the path, r/u, to the curvature for the steering angle, tan(`factor`
/// d_r)/l_f. r is the yaw rate, u the speed, d_r the logged angle, l_f the distance from the centre
/// of gravity to the front axle. The ratio is at most about 1 if `factor` d_r is the true angle in
/// rad. Windows in which the force difference turns the vehicle more than the steering are skipped.
/// Empty without a speed, without heading and yaw rate, or if the two curvatures are not
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
  return std::abs(ratio->ratio);
}

double largest_steering_deg(const DrivingLog& log) {
  double largest_deg = 0.0;
  for (const double angle : log.driving_steering_rad()) {
    largest_deg = std::max(largest_deg, std::abs(degrees(angle)));
  }
  return largest_deg;
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

/// Detects steering angles far beyond the stop, which are probably the command or the counts of a
/// servo.
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

/// Ratio of the path's curvature to that of the logged steering angle. In a log without a speed,
/// the yaw rate per moment of the steering, divided by the yaw rate per moment of a force
/// difference. Either ratio is about 1 if the angle was logged in degrees, and large if it was
/// logged in radians. 0 if the log does not determine it.
double times_as_sharp(const Evidence& evidence) {
  const double degree = degrees(1.0);
  if (const auto sharp = sharpness(evidence, degree)) return *sharp * degree;
  const MomentShares shares = moment_shares(
      evidence.windows, evidence.has(LogChannel::kHeading)
                            ? [](const EvidenceWindow& w) { return w.turned_rad; }
                            : [](const EvidenceWindow& w) { return w.rate_rad; });
  return shares.sides != 0.0 ? std::abs(shares.steering / shares.sides) : 0.0;
}

/// Detects angles in radians that are read as degrees: the largest is at most 2.5 % of the stop
/// (pi/180 is 1.7 %), and the vehicle turns at least 8 times (radians: about 57 times) as sharply
/// as the angle allows.
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

}  // namespace

std::optional<Contradiction> steering_unit_contradiction(const Evidence& evidence) {
  if (!evidence.vehicle.has_steering()) return check_absent_steering(evidence);
  const double largest_deg = largest_steering_deg(evidence.log);
  const std::string column(evidence.log.steering_column());
  if (auto large = check_large_angles(evidence, column, largest_deg)) return large;
  return check_radians(evidence, column, largest_deg);
}

}  // namespace awmr
