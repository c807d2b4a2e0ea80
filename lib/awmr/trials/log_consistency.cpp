#include "awmr/trials/log_consistency.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/trials/replay.h"
#include "awmr/trials/robust_ratio.h"

namespace awmr {
namespace {

constexpr double kWindow_s = 1.0;
/// A response follows its command by about this much; commands are averaged that much earlier.
constexpr double kResponse_s = 0.2;
/// Ratios within these are calibration, slip or noise; beyond them a unit is wrong.
constexpr double kLowestAgreement = 0.6;
constexpr double kHighestAgreement = 1.6;

/// A factor that a wrong unit makes, and what it is called.
struct UnitFactor {
  double factor;
  std::string_view words;
};

/// The known factor nearest to `ratio` (by its logarithm, within 20 %), if any.
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

/// What one window says of each signal; sums over the window, so that noise averages out.
struct WindowSums {
  double turned_rad = 0.0;    ///< change of heading
  double rate_rad = 0.0;      ///< integral of the yaw rate
  double moved_m = 0.0;       ///< distance between the first and the last position
  double course_rad = 0.0;    ///< its direction
  double heading_rad = 0.0;   ///< in the middle
  double driven_m = 0.0;      ///< integral of the speed
  double thrust = 0.0;        ///< mean of F'L + F'R
  double steering_rad = 0.0;  ///< mean command
  double tau_steering_m =
      0.0;                  ///< l_f (F'L + F'R) sin d_r                             [paper (41)]
  double tau_diff_m = 0.0;  ///< d (F'R - F'L)(cos d_r + 1)                          [paper (41)]
  double span_s = 0.0;
};

double integral_of(const DrivingLog& log, LogChannel channel, const LogWindow& window) {
  const std::vector<double>& value = log[channel]->value;
  double sum = 0.0;
  for (std::size_t i = window.begin; i + 1 < window.end; ++i) {
    sum += 0.5 * (value[i] + value[i + 1]) * (log.t_s[i + 1] - log.t_s[i]);
  }
  return sum;
}

const std::vector<double>& steering_of(const DrivingLog& log) {
  return log.steering_command_rad ? *log.steering_command_rad : log[LogChannel::kSteering]->value;
}

/// Commands as they acted on the window: averaged over the same length, a little earlier.
void add_commands(const DrivingLog& log, const Vehicle& vehicle, const LogWindow& window,
                  WindowSums& sums) {
  const double delay_s = log.steering_command_rad ? kResponse_s : 0.0;
  const auto row_at = [&](double t_s) {
    const auto at = std::lower_bound(log.t_s.begin(), log.t_s.end(), t_s - delay_s);
    return std::min(log.rows() - 1, static_cast<std::size_t>(at - log.t_s.begin()));
  };
  const std::size_t begin = row_at(log.t_s[window.begin]);
  const std::size_t end = std::max(begin + 1, row_at(log.t_s[window.end - 1]) + 1);
  const std::vector<double>& steering = steering_of(log);
  const double n = static_cast<double>(end - begin);
  for (std::size_t i = begin; i < end; ++i) {
    const double both = log.force_left[i] + log.force_right[i];
    const double apart = log.force_right[i] - log.force_left[i];
    sums.thrust += both / n;
    sums.steering_rad += steering[i] / n;
    sums.tau_steering_m += vehicle.front_axle_m * both * std::sin(steering[i]) / n;
    sums.tau_diff_m += vehicle.half_track_m * apart * (std::cos(steering[i]) + 1.0) / n;
  }
}

WindowSums sums_of(const DrivingLog& log, const Vehicle& vehicle, const LogWindow& window) {
  WindowSums sums;
  const std::size_t last = window.end - 1;
  sums.span_s = log.t_s[last] - log.t_s[window.begin];
  if (const auto& heading = log[LogChannel::kHeading]) {
    sums.turned_rad = heading->value[last] - heading->value[window.begin];
    sums.heading_rad = heading->value[(window.begin + last) / 2];
  }
  if (log[LogChannel::kYawRate]) sums.rate_rad = integral_of(log, LogChannel::kYawRate, window);
  if (log[LogChannel::kX] && log[LogChannel::kY]) {
    const double dx = log[LogChannel::kX]->value[last] - log[LogChannel::kX]->value[window.begin];
    const double dy = log[LogChannel::kY]->value[last] - log[LogChannel::kY]->value[window.begin];
    sums.moved_m = std::hypot(dx, dy);
    sums.course_rad = std::atan2(dy, dx);
  }
  if (log[LogChannel::kSpeed]) sums.driven_m = integral_of(log, LogChannel::kSpeed, window);
  add_commands(log, vehicle, window, sums);
  return sums;
}

template <class Member>
std::vector<double> series(const std::vector<WindowSums>& windows, Member member) {
  std::vector<double> values;
  values.reserve(windows.size());
  for (const WindowSums& w : windows) values.push_back(member(w));
  return values;
}

/// The log with its windows and the mappings it was read with: what every comparison needs.
struct Evidence {
  const DrivingLog& log;
  const Vehicle& vehicle;
  std::span<const ColumnMapping> mappings;
  std::vector<WindowSums> windows;

  bool has(LogChannel channel) const { return log[channel].has_value(); }
};

/// `NAME=SOURCE*FACTOR`, from the column that NAME was read from.
std::string scaled_mapping(const Evidence& evidence, std::string_view column, double factor) {
  std::string source(column);
  double scale = factor;
  for (const ColumnMapping& mapping : evidence.mappings) {
    if (mapping.name != column) continue;
    source = mapping.source;
    scale *= mapping.scale;
  }
  return fmt::format("{}=\"{}\"*{:.7g}", column, source, scale);
}

std::string swapped_mapping(const Evidence& evidence) {
  const auto source = [&](std::string_view column) {
    for (const ColumnMapping& mapping : evidence.mappings) {
      if (mapping.name == column)
        return fmt::format("\"{}\"*{:.7g}", mapping.source, mapping.scale);
    }
    return fmt::format("\"{}\"", column);
  };
  return fmt::format("force_left={}' and column 'force_right={}", source("force_right"),
                     source("force_left"));
}

std::optional<Contradiction> judge_time(const Evidence& evidence) {
  static constexpr std::array<UnitFactor, 3> kFactors{
      {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}}};
  const double step_s = evidence.log.median_step_s();
  const double ratio = step_s / evidence.vehicle.sample_time_s;
  for (const UnitFactor& unit : kFactors) {
    if (ratio < 0.3 * unit.factor || ratio > 30.0 * unit.factor) continue;
    return Contradiction{
        "t_s",
        fmt::format("rows are {:.4g} apart in t_s, {:.3g} times sample_time_s = {:g} s: the time "
                    "looks like {}",
                    step_s, ratio, evidence.vehicle.sample_time_s, unit.words),
        scaled_mapping(evidence, "t_s", 1.0 / unit.factor)};
  }
  return std::nullopt;
}

std::optional<Contradiction> judge_force(const Evidence& evidence, std::string_view column,
                                         const std::vector<double>& values,
                                         double largest_of_both) {
  static constexpr std::array<UnitFactor, 5> kFullScale{{{100.0, "percent"},
                                                         {255.0, "8-bit PWM counts"},
                                                         {1000.0, "per mille"},
                                                         {1023.0, "10-bit PWM counts"},
                                                         {4095.0, "12-bit PWM counts"}}};
  const Interval& limit = evidence.vehicle.wheel_force;
  constexpr double kRounding = 1.01;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double above = limit.hi * kRounding;
  const double below = limit.lo < 0.0 ? limit.lo * kRounding : -0.01 * limit.hi;
  if (*most <= above && *least >= below) return std::nullopt;
  const double worst = *most > above ? *most : *least;
  std::string words = "give the force over F_max, the largest force of one motor";
  double factor = limit.hi / largest_of_both;
  for (const UnitFactor& unit : kFullScale) {
    if (largest_of_both > unit.factor * 1.005 || largest_of_both <= 1.05 * limit.hi) continue;
    words = fmt::format("the forces look like {}", unit.words);
    factor = 1.0 / unit.factor;
    break;
  }
  return Contradiction{
      std::string(column),
      fmt::format("reaches {:.4g}, beyond wheel_force [{:g}, {:g}] of the vehicle: "
                  "{}",
                  worst, limit.lo, limit.hi, words),
      scaled_mapping(evidence, column, factor)};
}

std::vector<Contradiction> judge_forces(const Evidence& evidence) {
  double largest = 0.0;
  for (const auto* values : {&evidence.log.force_left, &evidence.log.force_right}) {
    for (const double value : *values) largest = std::max(largest, std::abs(value));
  }
  std::vector<Contradiction> found;
  for (const auto& [column, values] : {std::pair{"force_left", &evidence.log.force_left},
                                       std::pair{"force_right", &evidence.log.force_right}}) {
    if (auto one = judge_force(evidence, column, *values, largest)) found.push_back(*one);
  }
  return found;
}

/// The numbers of the heading column all lie within one turn counted in radians, +-3.15 or 0 to 6.3.
/// A vehicle that turns by less than 6 degrees in a whole log has shown nothing of its yaw anyway.
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

std::optional<Contradiction> judge_rates(const Evidence& evidence) {
  if (!evidence.has(LogChannel::kHeading) || !evidence.has(LogChannel::kYawRate)) return {};
  const auto ratio =
      robust_ratio(series(evidence.windows, [](const WindowSums& w) { return w.rate_rad; }),
                   series(evidence.windows, [](const WindowSums& w) { return w.turned_rad; }));
  if (!ratio) return std::nullopt;
  const double size = std::abs(ratio->ratio);
  if (size >= kLowestAgreement && size <= kHighestAgreement) return std::nullopt;
  const double degree = 180.0 / pi<double>();
  static constexpr std::array<UnitFactor, 3> kUnits{
      {{57.29578, ""}, {1.0 / 57.29578, ""}, {1e-3, "milliseconds"}}};
  const auto unit = known_factor(size, kUnits);
  const std::string compared =
      fmt::format("the heading turns {:.4g} times as far as the yaw rate says", size);
  if (unit && unit->factor < 0.1 && unit->factor > 0.01) {
    if (heading_spans_radians(evidence.log)) {
      return Contradiction{"heading_deg", compared + ": the heading looks like radians",
                           scaled_mapping(evidence, "heading_deg", degree)};
    }
    return Contradiction{"yaw_rate_radps",
                         compared + ": the yaw rate looks like degrees per second",
                         scaled_mapping(evidence, "yaw_rate_radps", 1.0 / degree)};
  }
  return Contradiction{"yaw_rate_radps",
                       compared + ": one of yaw_rate_radps, heading_deg and t_s has another unit",
                       scaled_mapping(evidence, "yaw_rate_radps", size)};
}

std::optional<Contradiction> judge_speed(const Evidence& evidence) {
  const bool position = evidence.has(LogChannel::kX) && evidence.has(LogChannel::kY);
  if (!position || !evidence.has(LogChannel::kSpeed)) return std::nullopt;
  const auto ratio = robust_ratio(
      series(evidence.windows, [](const WindowSums& w) { return std::abs(w.driven_m); }),
      series(evidence.windows, [](const WindowSums& w) { return w.moved_m; }));
  if (!ratio) return std::nullopt;
  if (ratio->ratio >= kLowestAgreement && ratio->ratio <= kHighestAgreement) return std::nullopt;
  static constexpr std::array<UnitFactor, 6> kSpeedUnits{{{1.0 / 3.6, "km/h"},
                                                          {0.44704, "miles per hour"},
                                                          {0.01, "cm/s"},
                                                          {1e-3, "mm/s"},
                                                          {0.51444, "knots"},
                                                          {0.3048, "ft/s"}}};
  static constexpr std::array<UnitFactor, 2> kPositionUnits{{{1e3, "mm"}, {100.0, "cm"}}};
  const std::string compared =
      fmt::format("the positions move {:.4g} times as far as the speed says", ratio->ratio);
  if (const auto unit = known_factor(ratio->ratio, kPositionUnits)) {
    return Contradiction{"x_m", compared + fmt::format(": the positions look like {}", unit->words),
                         scaled_mapping(evidence, "x_m", 1.0 / unit->factor) + "' and column '" +
                             scaled_mapping(evidence, "y_m", 1.0 / unit->factor)};
  }
  const auto unit = known_factor(ratio->ratio, kSpeedUnits);
  const double factor = unit ? unit->factor : ratio->ratio;
  return Contradiction{"speed_mps",
                       compared + (unit ? fmt::format(": the speed looks like {}", unit->words)
                                        : ": speed, position or time has another unit"),
                       scaled_mapping(evidence, "speed_mps", factor)};
}

/// The partial regression of a rate on the two moments; 0 where a moment's share is not shown.
struct MomentShares {
  double steering = 0.0;
  double sides = 0.0;
};

MomentShares moment_shares(const std::vector<WindowSums>& windows,
                           double (*rate)(const WindowSums&)) {
  double ss = 0.0, sd = 0.0, dd = 0.0, sr = 0.0, dr = 0.0, rr = 0.0;
  for (const WindowSums& w : windows) {
    const double y = rate(w) / w.span_s;
    ss += w.tau_steering_m * w.tau_steering_m;
    sd += w.tau_steering_m * w.tau_diff_m;
    dd += w.tau_diff_m * w.tau_diff_m;
    sr += w.tau_steering_m * y;
    dr += w.tau_diff_m * y;
    rr += y * y;
  }
  const double n = static_cast<double>(windows.size());
  const double determinant = ss * dd - sd * sd;
  const bool steering_only = dd < 1e-6 * ss;
  const bool sides_only = ss < 1e-6 * dd;
  const bool apart = determinant > 1e-3 * ss * dd && !steering_only && !sides_only;
  if (n < 10.0 || rr <= 0.0) return {};
  constexpr double kSignificant = 5.0;  // standard errors
  const auto shown = [&](double coefficient, double variance_factor, double explained) {
    const double noise = std::max(0.0, rr - explained) / std::max(1.0, n - 2.0);
    return std::abs(coefficient) > kSignificant * std::sqrt(noise * variance_factor) ? coefficient
                                                                                     : 0.0;
  };
  if (steering_only) return {shown(sr / ss, 1.0 / ss, sr * sr / ss), 0};
  if (sides_only) return {0.0, shown(dr / dd, 1.0 / dd, dr * dr / dd)};
  if (!apart) return {};
  const double bs = (sr * dd - dr * sd) / determinant;
  const double bd = (dr * ss - sr * sd) / determinant;
  const double explained = bs * sr + bd * dr;
  return {shown(bs, dd / determinant, explained), shown(bd, ss / determinant, explained)};
}

/// How sharply the vehicle turns for its steering angle, over what its front axle allows:
/// (r/u)/(tan d_r/l_f), at most about 1 for a vehicle that steers by its front axle. The angle is
/// taken times `factor`; windows in which the sides would then turn the vehicle more than its
/// steering are left out.
std::optional<double> sharpness(const Evidence& evidence, double factor) {
  const bool heading = evidence.has(LogChannel::kHeading);
  if (!evidence.has(LogChannel::kSpeed)) return std::nullopt;
  if (!heading && !evidence.has(LogChannel::kYawRate)) return std::nullopt;
  std::vector<double> pointed;
  std::vector<double> turned;
  for (const WindowSums& w : evidence.windows) {
    if (std::abs(w.tau_diff_m) > factor * std::abs(w.tau_steering_m)) continue;
    pointed.push_back(std::tan(factor * w.steering_rad) * w.driven_m /
                      evidence.vehicle.front_axle_m);
    turned.push_back(heading ? w.turned_rad : w.rate_rad);
  }
  const auto ratio = robust_ratio(pointed, turned);
  if (!ratio) return std::nullopt;
  return std::abs(ratio->ratio);
}

std::optional<Contradiction> judge_steering_unit(const Evidence& evidence) {
  const std::vector<double>& angle = steering_of(evidence.log);
  double largest_deg = 0.0;
  for (const double value : angle) largest_deg = std::max(largest_deg, std::abs(degrees(value)));
  const std::string column =
      evidence.log.steering_command_rad ? "steering_cmd_deg" : "steering_deg";
  const double stop_deg = evidence.vehicle.steering_max_deg;
  if (largest_deg > 3.0 * stop_deg) {
    return Contradiction{column,
                         fmt::format("reaches {:.4g} deg, where the stop is at {:g} deg: it looks "
                                     "like counts, microseconds or percent of the stop",
                                     largest_deg, stop_deg),
                         scaled_mapping(evidence, column, stop_deg / largest_deg)};
  }
  // In radians the stop itself would read as 1.7 % of what it is in degrees.
  if (largest_deg > 0.025 * stop_deg) return std::nullopt;
  const double degree = 180.0 / pi<double>();
  // As radians it turns no more sharply than its axle points, as degrees 57 times more; and a
  // moment by steering turns it about as well as the same moment by the sides.
  constexpr double kImpossible = 8.0;
  const MomentShares shares = moment_shares(
      evidence.windows, evidence.has(LogChannel::kHeading)
                            ? [](const WindowSums& w) { return w.turned_rad; }
                            : [](const WindowSums& w) { return w.rate_rad; });
  const auto sharp = sharpness(evidence, degree);
  const double times = sharp                 ? *sharp * degree
                       : shares.sides != 0.0 ? std::abs(shares.steering / shares.sides)
                                             : 0.0;
  if (times < kImpossible) return std::nullopt;
  return Contradiction{
      column,
      fmt::format("the vehicle turns {:.3g} times as sharply as its front axle points, whose "
                  "largest angle is {:.3g} % of the stop: the angle looks like radians",
                  times, 100.0 * largest_deg / stop_deg),
      scaled_mapping(evidence, column, degree)};
}

/// Columns whose sign may be wrong, and what that would mean.
enum class Signed { kSteering, kSides, kYawRate, kHeading, kY };
constexpr std::size_t kSignedCount = 5;

/// Two columns that agree (+1) or contradict each other (-1).
struct SignRelation {
  Signed a;
  Signed b;
  int sign;
};

/// +1: positions move where the heading points; -1: where its mirror image does; 0: cannot be told.
int course_sign(const std::vector<WindowSums>& windows) {
  std::vector<double> moved = series(windows, [](const WindowSums& w) { return w.moved_m; });
  const double far = median(moved);
  std::complex<double> same = 0.0, mirrored = 0.0, headings = 0.0;
  double n = 0.0;
  for (const WindowSums& w : windows) {
    if (w.moved_m < far || w.moved_m <= 0.0 || std::abs(w.turned_rad) > 1.0) continue;
    same += std::polar(1.0, w.course_rad - w.heading_rad);
    mirrored += std::polar(1.0, w.course_rad + w.heading_rad);
    headings += std::polar(1.0, 2.0 * w.heading_rad);
    n += 1.0;
  }
  // On a straight drive the two cannot be told apart.
  if (n < 10.0 || std::abs(headings) / n > 0.9) return 0;
  if (std::abs(same) / n > 0.7 && std::abs(same) > 1.5 * std::abs(mirrored)) return 1;
  if (std::abs(mirrored) / n > 0.7 && std::abs(mirrored) > 1.5 * std::abs(same)) return -1;
  return 0;
}

int sign_of(double value) { return value > 0.0 ? 1 : (value < 0.0 ? -1 : 0); }

std::vector<SignRelation> sign_relations(const Evidence& evidence) {
  std::vector<SignRelation> relations;
  const auto add = [&](Signed a, Signed b, int sign) {
    if (sign != 0) relations.push_back({a, b, sign});
  };
  const auto rate = [](const WindowSums& w) { return w.rate_rad; };
  const auto turn = [](const WindowSums& w) { return w.turned_rad; };
  if (evidence.has(LogChannel::kYawRate)) {
    const MomentShares shares = moment_shares(evidence.windows, rate);
    add(Signed::kSteering, Signed::kYawRate, sign_of(shares.steering));
    add(Signed::kSides, Signed::kYawRate, sign_of(shares.sides));
  }
  if (!evidence.has(LogChannel::kHeading)) return relations;
  const MomentShares shares = moment_shares(evidence.windows, turn);
  add(Signed::kSteering, Signed::kHeading, sign_of(shares.steering));
  add(Signed::kSides, Signed::kHeading, sign_of(shares.sides));
  if (evidence.has(LogChannel::kYawRate)) {
    const auto ratio = robust_ratio(series(evidence.windows, rate), series(evidence.windows, turn));
    if (ratio) add(Signed::kYawRate, Signed::kHeading, ratio->ratio > 0.0 ? 1 : -1);
  }
  if (evidence.has(LogChannel::kX) && evidence.has(LogChannel::kY)) {
    add(Signed::kHeading, Signed::kY, course_sign(evidence.windows));
  }
  return relations;
}

/// The smallest sets of columns whose signs, turned, make all relations agree.
std::vector<unsigned> smallest_flips(const std::vector<SignRelation>& relations) {
  std::vector<unsigned> best;
  std::size_t least = kSignedCount + 1;
  for (unsigned flips = 0; flips < (1U << kSignedCount); ++flips) {
    const auto flipped = [flips](Signed s) { return (flips >> static_cast<unsigned>(s)) & 1U; };
    const bool agrees = std::all_of(relations.begin(), relations.end(), [&](const SignRelation& r) {
      return (flipped(r.a) != flipped(r.b)) == (r.sign < 0);
    });
    const auto size = static_cast<std::size_t>(__builtin_popcount(flips));
    if (!agrees || size > least) continue;
    if (size < least) best.clear();
    least = size;
    best.push_back(flips);
  }
  return best;
}

Contradiction sign_contradiction(const Evidence& evidence, Signed which) {
  const std::string steering =
      evidence.log.steering_command_rad ? "steering_cmd_deg" : "steering_deg";
  switch (which) {
    case Signed::kSteering:
      return {steering, "the vehicle turns against its steering: positive is to the left",
              scaled_mapping(evidence, steering, -1.0)};
    case Signed::kSides:
      return {"force_left",
              "the vehicle turns towards the side that pushes harder: force_left and force_right "
              "look swapped",
              swapped_mapping(evidence)};
    case Signed::kYawRate:
      return {"yaw_rate_radps",
              "its sign is against the other channels: positive is counter-clockwise",
              scaled_mapping(evidence, "yaw_rate_radps", -1.0)};
    case Signed::kHeading:
      return {"heading_deg",
              "its sign is against the other channels: positive is counter-clockwise (a compass "
              "counts clockwise)",
              scaled_mapping(evidence, "heading_deg", -1.0)};
    case Signed::kY:
      break;
  }
  return {"y_m",
          "the positions move along the mirror image of the heading: y_m has the wrong sign (left "
          "is positive), or x_m and y_m are swapped",
          scaled_mapping(evidence, "y_m", -1.0)};
}

std::vector<Contradiction> judge_signs(const Evidence& evidence) {
  const std::vector<unsigned> solutions = smallest_flips(sign_relations(evidence));
  if (solutions.empty() || solutions.front() == 0U) return {};
  std::vector<Contradiction> found;
  for (std::size_t s = 0; s < kSignedCount; ++s) {
    const bool blamed = std::any_of(solutions.begin(), solutions.end(),
                                    [s](unsigned flips) { return ((flips >> s) & 1U) != 0U; });
    if (!blamed) continue;
    found.push_back(sign_contradiction(evidence, static_cast<Signed>(s)));
    if (solutions.size() > 1) found.back().message += " (or the other one named here is turned)";
  }
  return found;
}

/// Thrust forward and motion backward.
std::optional<Contradiction> judge_direction(const Evidence& evidence) {
  if (!evidence.has(LogChannel::kSpeed)) return std::nullopt;
  const auto ratio =
      robust_ratio(series(evidence.windows, [](const WindowSums& w) { return w.thrust; }),
                   series(evidence.windows, [](const WindowSums& w) { return w.driven_m; }));
  if (!ratio || ratio->ratio > 0.0) return std::nullopt;
  return Contradiction{"speed_mps",
                       "the speed is negative where both forces push forward: speed or forces have "
                       "the wrong sign",
                       scaled_mapping(evidence, "speed_mps", -1.0)};
}

}  // namespace

std::vector<Contradiction> contradictions(const DrivingLog& log, const Vehicle& vehicle,
                                          std::span<const ColumnMapping> mappings) {
  Evidence evidence{log, vehicle, mappings, {}};
  std::vector<Contradiction> found = judge_forces(evidence);
  // Windows of a second mean nothing before the time is right.
  if (auto time = judge_time(evidence)) {
    found.insert(found.begin(), *time);
    return found;
  }
  for (const LogWindow& window : windows_of(log, kWindow_s)) {
    evidence.windows.push_back(sums_of(log, vehicle, window));
  }
  for (const auto& judged : {judge_steering_unit(evidence), judge_rates(evidence),
                             judge_speed(evidence), judge_direction(evidence)}) {
    if (judged) found.push_back(*judged);
  }
  for (Contradiction& one : judge_signs(evidence)) found.push_back(std::move(one));
  return found;
}

std::optional<GyroBias> gyro_bias(const DrivingLog& log) {
  if (!log[LogChannel::kHeading] || !log[LogChannel::kYawRate]) return std::nullopt;
  std::vector<double> offsets;
  for (const LogWindow& window : windows_of(log, kWindow_s)) {
    const std::vector<double>& heading = log[LogChannel::kHeading]->value;
    const double span_s = log.t_s[window.end - 1] - log.t_s[window.begin];
    const double turned = heading[window.end - 1] - heading[window.begin];
    offsets.push_back((integral_of(log, LogChannel::kYawRate, window) - turned) / span_s);
  }
  if (offsets.size() < 10) return std::nullopt;
  const double bias = median(offsets);
  std::vector<double> deviations;
  for (const double offset : offsets) deviations.push_back(std::abs(offset - bias));
  // 1.4826 MAD is a normal's deviation; a median has 1.2533 times a mean's standard error.
  const double error =
      1.2533 * 1.4826 * median(deviations) / std::sqrt(static_cast<double>(offsets.size()));
  return GyroBias{bias, error};
}

bool has_gyro_bias(const DrivingLog& log) {
  constexpr double kPlain = 5.0;  // standard errors
  const auto bias = gyro_bias(log);
  return bias && std::abs(bias->bias_radps) > kPlain * bias->std_error_radps;
}

Status check_consistency(const DrivingLog& log, const std::string& place, const Vehicle& vehicle,
                         const TrialOptions& options, std::vector<Finding>& findings) {
  const std::vector<Contradiction> found = contradictions(log, vehicle, options.columns);
  std::vector<Fault> faults;
  for (const Contradiction& one : found) {
    if (options.as_is) {
      findings.push_back({log.file, 0, Severity::kWarning, "log-contradiction",
                          fmt::format("{}: {}", one.column, one.message)});
      continue;
    }
    faults.push_back(
        {place, fmt::format("{}: {}; map it by {}, or take it {}", one.column, one.message,
                            option_text("column '" + one.mapping + "'"), option_text("as-is"))});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  if (!found.empty()) return {};
  const auto bias = gyro_bias(log);
  if (has_gyro_bias(log)) {
    findings.push_back(
        {log.file, 0, Severity::kWarning, "gyro-bias",
         fmt::format("yaw_rate_radps stands {:.3g} +- {:.2g} rad/s off the heading's own rate: a "
                     "gyro's bias; it is estimated with the rest ({})",
                     bias->bias_radps, bias->std_error_radps,
                     option_text("fit bias.yaw_rate_radps"))});
  }
  return {};
}

}  // namespace awmr
