#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "awmr/core/option_text.h"
#include "awmr/core/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/model/plausibility.h"
#include "awmr/trials/log_evidence.h"
#include "awmr/trials/robust_ratio.h"
#include "force_units.h"

namespace awmr {
namespace {

/// A ratio of two channels within this range is due to calibration, slip or noise; outside it, a
/// unit is wrong.
constexpr double kLowestAgreement = 0.6;
constexpr double kHighestAgreement = 1.6;

/// A unit that a channel may have by mistake.
struct UnitFactor {
  double factor;  ///< ratio of the two compared channels if the unit is this one
  std::string_view words;
};

/// The unit whose factor is nearest to `ratio`; empty if none is within 20 %.
template <std::size_t N>
std::optional<UnitFactor> known_factor(double ratio, const std::array<UnitFactor, N>& factors) {
  std::optional<UnitFactor> best;
  double least = std::log(1.2);
  for (const UnitFactor& candidate : factors) {
    const double apart = std::abs(std::log(std::abs(ratio) / candidate.factor));
    if (apart < least) {
      least = apart;
      best = candidate;
    }
  }
  return best;
}

/// Contradiction that names `unit` as the unit of t_s.
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
  // Row spacings below 1 ms and below a twentieth of the sample time cannot be in seconds.
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
  if (of_both.largest <= std::max(limit.hi, -limit.lo) * kForceRounding) {
    // The vehicle permits this magnitude in the other direction, so the unit is right.
    return Contradiction{
        std::string(column), beyond + "the vehicle permits it only in the other direction", "",
        fmt::format("widen wheel_force in vehicle.json to {:.4g}, or correct the signs", worst)};
  }
  const ForceUnits units = force_units(of_both, evidence.vehicle);
  const std::vector<UnitFix> unit_fixes = force_unit_fixes(units, column);
  const std::string likeliest =
      unit_fixes.empty()
          ? ""
          : scaled_mapping(evidence, column, unit_fixes[0].factor, unit_fixes[0].offset);
  return Contradiction{std::string(column), beyond + words_of(units), likeliest,
                       remedy_of(units, unit_fixes, evidence.mappings)};
}

/// Range of the forces of both sides, without zeros: 0 in a column of servo pulses means no
/// reading.
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

/// True if the values of the heading column span at most 6.4 (2 pi and a margin), so that they may
/// be radians. (If they are degrees, the vehicle hardly turns in the whole log.)
bool heading_spans_radians(const DrivingLog& log) {
  double least = 360.0;
  double most = -360.0;
  for (const double value : log[LogChannel::kHeading]->value) {
    const double wrapped_deg = degrees(std::remainder(value, 2.0 * pi<double>()));
    least = std::min(least, wrapped_deg);
    most = std::max(most, wrapped_deg);
  }
  return most - least < 2.0 * pi<double>() + 0.1;
}

/// If turning_rate() is below this number, the unit of the yaw rate is not deg/s, because 2 deg/s
/// would hardly be a turn.
constexpr double kSlowTurn = 2.0;
/// Typical yaw rate while turning: the 75 % quantile over windows, in the unit of the column.
double turning_rate(const Evidence& evidence) {
  std::vector<double> rates = series(evidence.windows, [](const EvidenceWindow& w) {
    return w.span_s > 0.0 ? std::abs(w.rate_rad) / w.span_s : 0.0;
  });
  std::ranges::sort(rates);
  return rates[rates.size() * 3 / 4];
}

bool agree(double ratio) { return ratio >= kLowestAgreement && ratio <= kHighestAgreement; }

/// Subtracts the median from the values.
std::vector<double> centred(std::vector<double> values) {
  const double middle = median(values);
  for (double& value : values) value -= middle;
  return values;
}

/// 95 % quantile of the magnitude of the measurements, which spikes do not affect.
double usual_largest(const Measured& channel) {
  std::vector<double> sizes;
  for (std::size_t row = 0; row < channel.value.size(); ++row) {
    if (channel.fresh[row]) sizes.push_back(std::abs(channel.value[row]));
  }
  return sizes.empty() ? 0.0 : quantile(std::move(sizes), 0.95);
}

std::optional<Contradiction> check_rates(const Evidence& evidence) {
  if (!evidence.has(LogChannel::kHeading) || !evidence.has(LogChannel::kYawRate)) return {};
  const std::vector<double> rate =
      series(evidence.overlapping, [](const EvidenceWindow& w) { return w.rate_rad; });
  const std::vector<double> turned =
      series(evidence.overlapping, [](const EvidenceWindow& w) { return w.turned_rad; });
  const auto ratio = robust_ratio(rate, turned);
  if (!ratio) return std::nullopt;
  const double size = std::abs(ratio->ratio);
  if (agree(size)) return std::nullopt;
  // A large gyro bias also changes the ratio, but not after subtraction of the medians.
  const auto without_bias = robust_ratio(centred(rate), centred(turned));
  if (without_bias && agree(without_bias->ratio)) return std::nullopt;
  const double degree = 180.0 / pi<double>();
  // Factors that convert the column to rad/s.
  static constexpr std::array<UnitFactor, 5> kUnits{
      {{57.29578, "rad/s, converted from deg/s once too often"},
       {1.0 / 57.29578, "degrees per second"},
       {0.1047198, "revolutions per minute"},
       {6.283185, "revolutions per second"},
       {1e-3, "mrad/s"}}};
  const auto unit = known_factor(size, kUnits);
  const std::string compared =
      fmt::format("the heading changes by {:.4g} times the integral of the yaw rate", size);
  if (unit && unit->factor == 1.0 / 57.29578) {
    if (heading_spans_radians(evidence.log) || turning_rate(evidence) < kSlowTurn) {
      return Contradiction{"heading_deg", compared + ": the heading looks like radians",
                           scaled_mapping(evidence, "heading_deg", degree)};
    }
    return Contradiction{"yaw_rate_radps",
                         compared + ": the yaw rate looks like degrees per second",
                         scaled_mapping(evidence, "yaw_rate_radps", 1.0 / degree)};
  }
  if (unit) {
    return Contradiction{"yaw_rate_radps",
                         compared + fmt::format(": the yaw rate looks like {}", unit->words),
                         scaled_mapping(evidence, "yaw_rate_radps", unit->factor)};
  }
  return Contradiction{"yaw_rate_radps", compared + ", which no known unit explains", "",
                       "compare the units of yaw_rate_radps, heading_deg and t_s with the sensors' "
                       "data sheets"};
}

/// Ratio of the yaw rate to that of rolling wheels, u tan(d)/(2 l_f) (d: steering angle, 2 l_f:
/// about the wheelbase), in windows with about equal forces on both sides.
std::optional<double> rate_over_rolling(const Evidence& evidence) {
  constexpr double kLittle = 0.1;  // fraction of the steering moment
  if (!evidence.has(LogChannel::kSpeed) || !evidence.vehicle.has_steering()) return std::nullopt;
  std::vector<double> rolling;
  std::vector<double> rate;
  for (const EvidenceWindow& w : evidence.overlapping) {
    if (std::abs(w.tau_diff_m) > kLittle * std::abs(w.tau_steering_m)) continue;
    rolling.push_back(w.driven_m * std::tan(w.steering_rad) /
                      (2.0 * evidence.vehicle.front_axle_m));
    rate.push_back(w.rate_rad);
  }
  const auto ratio = robust_ratio(rolling, rate);
  if (!ratio) return std::nullopt;
  return std::abs(ratio->ratio);
}

/// Detects a yaw rate in deg/s in logs without a heading, because the values are too large for a
/// wheeled vehicle, or for its steering angle and speed.
std::optional<Contradiction> check_rate_alone(const Evidence& evidence) {
  constexpr double kLargest_radps = 25.0;  // as for turning tables (turn_evidence.h)
  if (!evidence.has(LogChannel::kYawRate) || evidence.has(LogChannel::kHeading)) return {};
  const double rate_radps = usual_largest(*evidence.log[LogChannel::kYawRate]);
  // Sliding wheels turn the vehicle less or more than rolling ones, but not by this factor. deg/s
  // instead of rad/s give a factor of 57.
  constexpr double kMaxSlide = 14.0;
  if (rate_radps <= kLargest_radps) {
    const auto ratio = rate_over_rolling(evidence);
    if (!ratio || *ratio <= kMaxSlide) return std::nullopt;
    return Contradiction{
        "yaw_rate_radps",
        fmt::format(
            "is {:.3g} times the yaw rate of rolling wheels at this speed and steering angle, "
            "u tan(d)/(2 l_f): it looks like degrees per second",
            *ratio),
        scaled_mapping(evidence, "yaw_rate_radps", pi<double>() / 180.0)};
  }
  return Contradiction{"yaw_rate_radps",
                       fmt::format("reaches {:.4g} rad/s, beyond the {:g} rad/s of any wheeled "
                                   "vehicle: it looks like degrees per second",
                                   rate_radps, kLargest_radps),
                       scaled_mapping(evidence, "yaw_rate_radps", pi<double>() / 180.0)};
}

/// Text for a speed that may be the angular rate of a wheel (rpm or rad/s), with the wheel radius
/// that this implies; empty if no radius is plausible for this vehicle. `ratio`: m/s per unit of
/// the column.
std::string words_of_wheel(double ratio, const Vehicle& vehicle) {
  constexpr double kSmallestRadius_m = 0.01;
  const double rpm_radius_m = ratio * 60.0 / (2.0 * pi<double>());
  const auto fits = [&](double radius_m) {
    return radius_m >= kSmallestRadius_m && radius_m <= 0.5 * vehicle.length_m;
  };
  std::string words;
  if (fits(rpm_radius_m))
    words += fmt::format("; if it is rpm of a wheel, the wheel radius is {:.3g} m", rpm_radius_m);
  if (fits(ratio))
    words += fmt::format("; if it is rad/s of a wheel, the wheel radius is {:.3g} m", ratio);
  return words;
}

/// Noise variance sigma^2 of a position measurement along one axis, m^2. Estimated from the second
/// differences d2x, d2y of consecutive measurements. For white noise, d2x^2 + d2y^2 is
/// exponentially distributed:
///
///     mean = 12 sigma^2,   lower quartile = 12 sigma^2 ln(4/3)
///
/// The lower quartile is used, because acceleration of the vehicle only increases the sum. Returns
/// 0 with fewer than three measurements.
double position_variance_m2(const DrivingLog& log) {
  const Measured& x = *log[LogChannel::kX];
  const Measured& y = *log[LogChannel::kY];
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (x.fresh[row] && y.fresh[row]) rows.push_back(row);
  }
  if (rows.size() < 3) return 0.0;
  std::vector<double> squares;
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
    const auto bend = [&](const std::vector<double>& value) {
      return value[rows[i - 1]] - 2.0 * value[rows[i]] + value[rows[i + 1]];
    };
    squares.push_back(std::pow(bend(x.value), 2) + std::pow(bend(y.value), 2));
  }
  return quantile(std::move(squares), 0.25) / (12.0 * std::log(4.0 / 3.0));
}

/// Ratio, over the windows, of the distance between first and last position to the integral of the
/// speed. The noise sigma of the two positions makes the distance longer: E moved^2 = true^2 +
/// 4 sigma^2. The term 4 sigma^2 is therefore subtracted. Empty if the median distance in the
/// faster half of the windows is below twice that of noise alone.
std::optional<RobustRatio> moved_over_driven(const Evidence& evidence) {
  constexpr double kClear = 4.0;  // ratio of the squares
  const double noise_m2 = 4.0 * position_variance_m2(evidence.log);
  std::vector<double> driven;
  std::vector<double> moved;
  for (const EvidenceWindow& w : evidence.overlapping) {
    if (w.has_stuck_speed) continue;  // a stuck value shows no unit
    driven.push_back(std::abs(w.driven_m));
    moved.push_back(std::sqrt(std::max(0.0, w.moved_m * w.moved_m - noise_m2)));
  }
  if (driven.empty()) return std::nullopt;
  std::vector<double> far;
  const double half = median(driven);
  for (std::size_t i = 0; i < driven.size(); ++i) {
    if (driven[i] >= half) far.push_back(moved[i]);
  }
  const double usual_m = median(std::move(far));
  if (usual_m * usual_m < (kClear - 1.0) * noise_m2) return std::nullopt;
  return robust_ratio(driven, moved);
}

std::optional<Contradiction> check_speed(const Evidence& evidence) {
  const bool position = evidence.has(LogChannel::kX) && evidence.has(LogChannel::kY);
  if (!position || !evidence.has(LogChannel::kSpeed)) return std::nullopt;
  const auto ratio = moved_over_driven(evidence);
  if (!ratio) return std::nullopt;
  if (ratio->ratio >= kLowestAgreement && ratio->ratio <= kHighestAgreement) return std::nullopt;
  static constexpr std::array<UnitFactor, 6> kSpeedUnits{{{1.0 / 3.6, "km/h"},
                                                          {0.44704, "miles per hour"},
                                                          {0.01, "cm/s"},
                                                          {1e-3, "mm/s"},
                                                          {0.51444, "knots"},
                                                          {0.3048, "ft/s"}}};
  static constexpr std::array<UnitFactor, 4> kPositionUnits{
      {{1e3, "mm"}, {100.0, "cm"}, {1.0 / 0.0254, "inches"}, {1.0 / 0.3048, "feet"}}};
  const std::string compared =
      fmt::format("the positions move by {:.4g} times the integral of the speed", ratio->ratio);
  if (const auto unit = known_factor(ratio->ratio, kPositionUnits)) {
    const std::string x = scaled_mapping(evidence, "x_m", 1.0 / unit->factor);
    const std::string y = scaled_mapping(evidence, "y_m", 1.0 / unit->factor);
    return Contradiction{
        "x_m", compared + fmt::format(": the positions look like {}", unit->words), x,
        fmt::format("map them with {} and {}", option_text(fmt::format("column '{}'", x)),
                    option_text(fmt::format("column '{}'", y)))};
  }
  if (const auto unit = known_factor(ratio->ratio, kSpeedUnits)) {
    return Contradiction{"speed_mps",
                         compared + fmt::format(": the speed looks like {}", unit->words),
                         scaled_mapping(evidence, "speed_mps", unit->factor)};
  }
  return Contradiction{
      "speed_mps",
      compared + ", which no known unit explains" + words_of_wheel(ratio->ratio, evidence.vehicle),
      "",
      "compare the units of speed_mps, x_m, y_m and t_s with the sensors' data "
      "sheets"};
}

/// Detects a speed that is too large for a wheeled vehicle of this length, in logs without
/// positions.
std::optional<Contradiction> check_speed_alone(const Evidence& evidence) {
  constexpr double kLargest_mps = 100.0;
  constexpr double kLargestLengthsPerSecond = 100.0;  // as for surge tables
  if (!evidence.has(LogChannel::kSpeed) || !implausible_values(evidence.vehicle).empty()) return {};
  const double length_m = evidence.vehicle.length_m;
  const double speed_mps = usual_largest(*evidence.log[LogChannel::kSpeed]);
  const double limit_mps = std::min(kLargest_mps, kLargestLengthsPerSecond * length_m);
  if (speed_mps <= limit_mps) return std::nullopt;
  return Contradiction{
      "speed_mps",
      fmt::format(
          "reaches {:.4g} m/s; above {:.4g} m/s is implausible for a wheeled vehicle of length "
          "{:g} m: it looks like rpm of a wheel or motor, cm/s or mm/s",
          speed_mps, limit_mps, length_m),
      "",
      fmt::format("map cm/s with {}, mm/s with {}, rpm with the factor 2 pi RADIUS_M/(60 "
                  "GEAR_RATIO)",
                  option_text("column '" + scaled_mapping(evidence, "speed_mps", 0.01) + "'"),
                  option_text("column '" + scaled_mapping(evidence, "speed_mps", 1e-3) + "'"))};
}

/// Ratio of the curvature of the path to that of the steering angle: (r/u)/(tan(factor d_r)/l_f).
/// It is at most about 1 if `factor` converts the logged angle to rad. Windows in which the force
/// difference turns the vehicle more than its steering are skipped. Empty without speed, or without
/// both heading and yaw rate, or if the two curvatures are not proportional.
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

/// Detects a servo command in place of the steering angle: a servo angle about 90 or 180 deg, a
/// pulse length in us, or percent of the stop.
std::optional<Contradiction> check_servo(const Evidence& evidence, const std::string& column) {
  const std::vector<double>& angle_rad = evidence.log.driving_steering_rad();
  const auto [low_rad, high_rad] = std::ranges::minmax_element(angle_rad);
  const double low = degrees(*low_rad);
  const double high = degrees(*high_rad);
  const double stop_deg = evidence.vehicle.steering_max_deg;
  const std::string reads = fmt::format(
      "goes from {:.4g} to {:.4g} deg, while the stop is at {:g} deg", low, high, stop_deg);
  // Calibration and trim may move both ends slightly beyond the stop.
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
                             ": it looks like a servo's pulse in us, 1500 straight ahead and 500 "
                             "to the stop",
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

std::optional<Contradiction> check_steering_unit(const Evidence& evidence) {
  const double largest_deg = largest_steering_deg(evidence.log);
  const std::string column(evidence.log.steering_column());
  const double stop_deg = evidence.vehicle.steering_max_deg;
  if (largest_deg > 1.5 * stop_deg) {
    if (auto servo = check_servo(evidence, column)) return servo;
  }
  if (largest_deg > 3.0 * stop_deg) {
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
  // An angle in radians that is read as degrees is at most 1.7 % (pi/180) of the stop.
  if (largest_deg > 0.025 * stop_deg) return std::nullopt;
  const double degree = 180.0 / pi<double>();
  // Angles in radians that are read as degrees make the vehicle seem to turn 57 times as sharply as
  // its wheels point. Without a speed, the yaw rates per moment of steering and of a force
  // difference are compared: they are about the same in the right unit.
  constexpr double kImpossible = 8.0;
  const MomentShares shares = moment_shares(
      evidence.windows, evidence.has(LogChannel::kHeading)
                            ? [](const EvidenceWindow& w) { return w.turned_rad; }
                            : [](const EvidenceWindow& w) { return w.rate_rad; });
  const auto sharp = sharpness(evidence, degree);
  const double times = sharp                 ? *sharp * degree
                       : shares.sides != 0.0 ? std::abs(shares.steering / shares.sides)
                                             : 0.0;
  if (times < kImpossible) return std::nullopt;
  return Contradiction{
      column,
      fmt::format("the vehicle turns {:.3g} times as sharply as this steering angle allows, and "
                  "the largest angle is {:.3g} % of the stop: the angle looks like radians",
                  times, 100.0 * largest_deg / stop_deg),
      scaled_mapping(evidence, column, degree)};
}

}  // namespace

std::vector<Contradiction> unit_contradictions(const Evidence& evidence) {
  std::vector<Contradiction> found = check_forces(evidence);
  // With a wrong unit of time, windows of one second have no meaning.
  if (auto time = check_time(evidence)) {
    found.insert(found.begin(), *time);
    return found;
  }
  const auto steering = evidence.vehicle.has_steering() ? check_steering_unit(evidence)
                                                        : check_absent_steering(evidence);
  const auto speed = check_speed(evidence);
  for (const auto& evaluated : {steering, check_rates(evidence), check_rate_alone(evidence),
                                speed ? speed : check_speed_alone(evidence)}) {
    if (evaluated) found.push_back(*evaluated);
  }
  return found;
}

}  // namespace awmr
