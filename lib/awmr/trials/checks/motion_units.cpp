// Checks of a log for wrong units of speeds, yaw rates, headings and positions (log_consistency.h).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "awmr/core/option_text.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/model/plausibility.h"
#include "awmr/trials/checks/log_evidence.h"

namespace awmr {
namespace {

/// True if the ratio of two channels is 0.6 to 1.6. Such a ratio can be due to calibration errors,
/// slip or noise; any other ratio means a wrong unit.
bool agree(double ratio) { return ratio >= 0.6 && ratio <= 1.6; }

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

/// Below this value of turning_rate(), the yaw rate counts as rad/s, because at less than 2 deg/s
/// the vehicle would hardly turn.
constexpr double kSlowTurn = 2.0;
/// Typical yaw rate while turning: the 75 % quantile over windows, in the unit of the column.
double turning_rate(const Evidence& evidence) {
  std::vector<double> rates = series(evidence.windows, [](const EvidenceWindow& w) {
    return w.span_s > 0.0 ? std::abs(w.rate_rad) / w.span_s : 0.0;
  });
  std::ranges::sort(rates);
  return rates[rates.size() * 3 / 4];
}

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

/// Ratio of the change of heading to the integral of the yaw rate. Empty if the two agree (with or
/// without correction of the gyro's bias) or are not proportional.
std::optional<double> turned_over_rate(const Evidence& evidence) {
  const std::vector<double> rate =
      series(evidence.overlapping, [](const EvidenceWindow& w) { return w.rate_rad; });
  const std::vector<double> turned =
      series(evidence.overlapping, [](const EvidenceWindow& w) { return w.turned_rad; });
  const auto ratio = robust_ratio(rate, turned);
  if (!ratio) return std::nullopt;
  const double size = std::abs(*ratio);
  if (agree(size)) return std::nullopt;
  // A large gyro bias changes the ratio of the signals, but not the ratio of their deviations from
  // the medians.
  const auto without_bias = robust_ratio(centred(rate), centred(turned));
  if (without_bias && agree(*without_bias)) return std::nullopt;
  return size;
}

std::optional<Contradiction> check_rates(const Evidence& evidence) {
  if (!evidence.has(LogChannel::kHeading) || !evidence.has(LogChannel::kYawRate)) return {};
  const std::optional<double> size = turned_over_rate(evidence);
  if (!size) return std::nullopt;
  const double degree = 180.0 / pi<double>();
  // Factors that convert the column to rad/s.
  static constexpr std::array<UnitFactor, 5> kUnits{
      {{57.29578, "rad/s, converted from deg/s once too often"},
       {1.0 / 57.29578, "degrees per second"},
       {0.1047198, "revolutions per minute"},
       {6.283185, "revolutions per second"},
       {1e-3, "mrad/s"}}};
  const auto unit = known_factor(*size, kUnits);
  const std::string compared =
      fmt::format("the heading changes by {:.4g} times the integral of the yaw rate", *size);
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

/// Ratio of the yaw rate to that of wheels that roll without sliding, u tan(d)/(2 l_f). u: speed;
/// d: steering angle; 2 l_f: about the wheelbase. Leaves out windows with clearly different forces
/// left and right, because such forces also make a yaw moment.
std::optional<double> rate_over_rolling(const Evidence& evidence) {
  // Forces left and right count as equal if the yaw moment of their difference is at most this
  // fraction of the yaw moment of the steering.
  constexpr double kLittle = 0.1;
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
  return std::abs(*ratio);
}

/// Detects a yaw rate in deg/s in logs without a heading. Its values are too large for any wheeled
/// vehicle, or for the steering angle and the speed.
std::optional<Contradiction> check_rate_alone(const Evidence& evidence) {
  constexpr double kLargest_radps = 25.0;  // largest plausible yaw rate, as in turn_evidence.cpp
  if (!evidence.has(LogChannel::kYawRate) || evidence.has(LogChannel::kHeading)) return {};
  const double rate_radps = usual_largest(*evidence.log[LogChannel::kYawRate]);
  // Largest ratio that sliding wheels can explain. A yaw rate in deg/s instead of rad/s gives a
  // ratio of about 57.
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
/// Acceleration of the vehicle makes some of the sums larger, and changes the lower quartile least.
/// Returns 0 with fewer than three measurements.
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

/// Ratio of the distance between the first and the last position of a window to the integral of the
/// speed, as a robust ratio over all windows. Noise makes the distance longer: with the standard
/// deviation sigma of each coordinate, the expected square is true distance^2 + 4 sigma^2. The
/// function therefore subtracts 4 sigma^2 from the square. Empty if the median distance in the
/// faster half of the windows is below twice the distance that noise alone would give.
std::optional<double> moved_over_driven(const Evidence& evidence) {
  // Smallest accepted ratio of the median squared distance to that of noise alone.
  constexpr double kClear = 4.0;
  const double noise_m2 = 4.0 * position_variance_m2(evidence.log);
  std::vector<double> driven;
  std::vector<double> moved;
  for (const EvidenceWindow& w : evidence.overlapping) {
    if (w.has_stuck_speed) continue;  // a stuck speed says nothing about its unit
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
  if (agree(*ratio)) return std::nullopt;
  static constexpr std::array<UnitFactor, 6> kSpeedUnits{{{1.0 / 3.6, "km/h"},
                                                          {0.44704, "miles per hour"},
                                                          {0.01, "cm/s"},
                                                          {1e-3, "mm/s"},
                                                          {0.51444, "knots"},
                                                          {0.3048, "ft/s"}}};
  static constexpr std::array<UnitFactor, 4> kPositionUnits{
      {{1e3, "mm"}, {100.0, "cm"}, {1.0 / 0.0254, "inches"}, {1.0 / 0.3048, "feet"}}};
  const std::string compared =
      fmt::format("the positions move by {:.4g} times the integral of the speed", *ratio);
  if (const auto unit = known_factor(*ratio, kPositionUnits)) {
    const std::string x = scaled_mapping(evidence, "x_m", 1.0 / unit->factor);
    const std::string y = scaled_mapping(evidence, "y_m", 1.0 / unit->factor);
    return Contradiction{
        "x_m", compared + fmt::format(": the positions look like {}", unit->words), x,
        fmt::format("map them with {} and {}", option_text(fmt::format("column '{}'", x)),
                    option_text(fmt::format("column '{}'", y)))};
  }
  if (const auto unit = known_factor(*ratio, kSpeedUnits)) {
    return Contradiction{"speed_mps",
                         compared + fmt::format(": the speed looks like {}", unit->words),
                         scaled_mapping(evidence, "speed_mps", unit->factor)};
  }
  return Contradiction{
      "speed_mps",
      compared + ", which no known unit explains" + words_of_wheel(*ratio, evidence.vehicle), "",
      "compare the units of speed_mps, x_m, y_m and t_s with the sensors' data "
      "sheets"};
}

/// Detects a speed too large for a vehicle of this length, in logs without positions.
std::optional<Contradiction> check_speed_alone(const Evidence& evidence) {
  constexpr double kLargest_mps = 100.0;
  constexpr double kLargestLengthsPerSecond = 100.0;  // as in table_units.h
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
                  mapping_option(evidence.mappings, "speed_mps", 0.01),
                  mapping_option(evidence.mappings, "speed_mps", 1e-3))};
}

}  // namespace

std::vector<Contradiction> motion_unit_contradictions(const Evidence& evidence) {
  std::vector<Contradiction> found;
  const auto speed = check_speed(evidence);
  for (const auto& evaluated : {check_rates(evidence), check_rate_alone(evidence),
                                speed ? speed : check_speed_alone(evidence)}) {
    if (evaluated) found.push_back(*evaluated);
  }
  return found;
}

}  // namespace awmr
