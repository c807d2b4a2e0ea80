#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <span>
#include <string>

#include "awmr/core/option_text.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/trials/checks/log_evidence.h"

namespace awmr {
namespace {

/// Columns whose sign may be wrong. kSides stands for the difference of force_right and force_left:
/// if its sign is wrong, the two columns are swapped.
enum class Signed { kSteering, kSides, kYawRate, kHeading, kY };
constexpr std::size_t kSignedCount = 5;

/// Observed relation of the signs of two columns.
struct SignRelation {
  Signed a;
  Signed b;
  int sign;  ///< +1: the signs of both columns agree; -1: one of them is wrong
};

/// Relation of the course over ground (the direction in which the positions move) to the heading.
struct CourseRelation {
  /// +1: positions move along the heading; -1: along its mirror image; 0: undetermined.
  int sign = 0;
  /// Mean angle from the heading (sign = 1) or its mirror image (sign = -1) to the course.
  double offset_rad = 0.0;
};

CourseRelation course_relation(std::span<const EvidenceWindow> windows) {
  // On a circular arc, the chord is parallel to the heading in the middle of the arc. Arcs near a
  // full circle have a short, uncertain chord.
  constexpr double kFurthestTurn_rad = 2.5;
  if (windows.empty()) return {};
  std::vector<double> moved;
  for (const EvidenceWindow& w : windows) moved.push_back(w.moved_m);
  const double far = median(moved);
  std::complex<double> same = 0.0, mirrored = 0.0, headings = 0.0;
  double n = 0.0;
  for (const EvidenceWindow& w : windows) {
    if (w.moved_m < far || w.moved_m <= 0.0 || std::abs(w.turned_rad) > kFurthestTurn_rad) continue;
    same += std::polar(1.0, w.course_rad - w.heading_rad);
    mirrored += std::polar(1.0, w.course_rad + w.heading_rad);
    headings += std::polar(1.0, 2.0 * w.heading_rad);
    n += 1.0;
  }
  // On a straight drive, the heading and its mirror image cannot be distinguished.
  if (n < 10.0 || std::abs(headings) / n > 0.95) return {};
  // Largest scatter of the angles between heading and course, on a scale from 0 to 1. With the
  // right sign of the heading, only noise scatters these angles. With the wrong sign, each angle
  // has an error of twice the heading.
  constexpr double kMaxNoise = 0.3;
  const auto holds = [n](double one, double other) {
    const double of_one = 1.0 - one / n;
    return of_one < kMaxNoise && (one > 1.5 * other || 1.0 - other / n > 4.0 * of_one);
  };
  if (holds(std::abs(same), std::abs(mirrored))) return {1, std::arg(same)};
  if (holds(std::abs(mirrored), std::abs(same))) return {-1, std::arg(mirrored)};
  return {};
}

/// Returns the sign of course_relation() for logs without a heading. The integral of the yaw rate
/// replaces the heading. As this integral drifts, the function evaluates parts of 60 windows (about
/// a minute) separately. Returns 0 if two parts contradict each other, or if no part determines the
/// sign.
int turning_sign(std::span<const EvidenceWindow> windows) {
  constexpr std::size_t kPart = 60;
  int sign = 0;
  for (std::size_t begin = 0; begin < windows.size(); begin += kPart) {
    const int one =
        course_relation(windows.subspan(begin, std::min(kPart, windows.size() - begin))).sign;
    if (one * sign < 0) return 0;
    if (one != 0) sign = one;
  }
  return sign;
}

int sign_of(double value) { return value > 0.0 ? 1 : (value < 0.0 ? -1 : 0); }

std::vector<SignRelation> sign_relations(const Evidence& evidence) {
  std::vector<SignRelation> relations;
  const auto add = [&](Signed a, Signed b, int sign) {
    if (sign != 0) relations.push_back({a, b, sign});
  };
  const auto rate = [](const EvidenceWindow& w) { return w.rate_rad; };
  const auto turn = [](const EvidenceWindow& w) { return w.turned_rad; };
  if (evidence.has(LogChannel::kYawRate)) {
    const MomentShares shares = moment_shares(evidence.windows, rate);
    add(Signed::kSteering, Signed::kYawRate, sign_of(shares.steering));
    add(Signed::kSides, Signed::kYawRate, sign_of(shares.sides));
  }
  const bool has_position = evidence.has(LogChannel::kX) && evidence.has(LogChannel::kY);
  if (!evidence.has(LogChannel::kHeading)) {
    if (has_position) add(Signed::kYawRate, Signed::kY, turning_sign(evidence.overlapping));
    return relations;
  }
  const MomentShares shares = moment_shares(evidence.windows, turn);
  add(Signed::kSteering, Signed::kHeading, sign_of(shares.steering));
  add(Signed::kSides, Signed::kHeading, sign_of(shares.sides));
  if (evidence.has(LogChannel::kYawRate)) {
    const auto ratio =
        robust_ratio(series(evidence.overlapping, rate), series(evidence.overlapping, turn));
    if (ratio) add(Signed::kYawRate, Signed::kHeading, *ratio > 0.0 ? 1 : -1);
  }
  if (has_position) {
    add(Signed::kHeading, Signed::kY, course_relation(evidence.overlapping).sign);
  }
  return relations;
}

unsigned bit(Signed column) { return 1U << static_cast<unsigned>(column); }

/// Returns the smallest sets of columns that may have the wrong sign. If the signs of all columns
/// of such a set are changed, all relations agree. A set has one bit per column. `fixed`: columns
/// whose sign is known to be right.
std::vector<unsigned> smallest_flips(const std::vector<SignRelation>& relations, unsigned fixed) {
  std::vector<unsigned> best;
  std::size_t least = kSignedCount + 1;
  for (unsigned flips = 0; flips < (1U << kSignedCount); ++flips) {
    if ((flips & fixed) != 0U) continue;
    const auto flipped = [flips](Signed s) { return (flips & bit(s)) != 0U; };
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

/// Multiple of 90 deg that must be added to the heading after its sign was changed, if a compass
/// counts from north and x points east. 0 if the positions show no such offset.
double mirrored_heading_deg(const Evidence& evidence) {
  constexpr double kQuarter_deg = 90.0;
  // Largest accepted difference from a multiple of 90, due to declination and sideslip, deg.
  constexpr double kClose_deg = 20.0;
  if (!evidence.has(LogChannel::kX) || !evidence.has(LogChannel::kY)) return 0.0;
  const CourseRelation course = course_relation(evidence.overlapping);
  if (course.sign != -1) return 0.0;
  const double offset_deg = degrees(course.offset_rad);
  const double nearest_deg = kQuarter_deg * std::round(offset_deg / kQuarter_deg);
  return std::abs(offset_deg - nearest_deg) < kClose_deg ? nearest_deg : 0.0;
}

Contradiction sign_contradiction(const Evidence& evidence, Signed which) {
  const std::string steering(evidence.log.steering_column());
  switch (which) {
    case Signed::kSteering:
      return {steering,
              "the vehicle turns in the direction opposite to its steering (left is positive)",
              scaled_mapping(evidence, steering, -1.0)};
    case Signed::kSides: {
      const auto [left, right] = swapped_mappings(evidence);
      return {"force_left",
              "the vehicle turns towards the side with the larger force: force_left and "
              "force_right look swapped",
              left,
              fmt::format("map them with {} {}", option_text("column '" + left + "'"),
                          option_text("column '" + right + "'"))};
    }
    case Signed::kYawRate:
      return {"yaw_rate_radps",
              "its sign contradicts the other channels: positive is counter-clockwise",
              scaled_mapping(evidence, "yaw_rate_radps", -1.0)};
    case Signed::kHeading:
      return {"heading_deg",
              "its sign contradicts the other channels: positive is counter-clockwise (a compass "
              "counts clockwise)",
              scaled_mapping(evidence, "heading_deg", -1.0, mirrored_heading_deg(evidence))};
    case Signed::kY:
      break;
  }
  return {
      "y_m",
      fmt::format("the positions {}: y_m has the wrong sign (left is positive), or x_m and y_m "
                  "are swapped",
                  evidence.has(LogChannel::kHeading) ? "move along the mirror image of the heading"
                                                     : "turn against the yaw rate"),
      scaled_mapping(evidence, "y_m", -1.0)};
}

/// Text that lists the alternative sets of wrong columns: "a, or b and c". `columns`: names of the
/// columns, in the order of the enumerators of Signed.
std::string alternatives(const std::array<std::string, kSignedCount>& columns,
                         const std::vector<unsigned>& solutions) {
  std::string text;
  for (const unsigned flips : solutions) {
    text += text.empty() ? "" : ", or ";
    const char* joint = "";
    for (std::size_t s = 0; s < kSignedCount; ++s) {
      if ((flips & bit(static_cast<Signed>(s))) == 0U) continue;
      text += joint + columns[s];
      joint = " and ";
    }
  }
  return text;
}

std::vector<Contradiction> check_signs(const Evidence& evidence) {
  // Positions from latitude and longitude have the right sign, so y cannot be the wrong column.
  const unsigned fixed = evidence.log.is_geographic ? bit(Signed::kY) : 0U;
  const std::vector<unsigned> solutions = smallest_flips(sign_relations(evidence), fixed);
  if (solutions.empty() || solutions.front() == 0U) return {};
  std::vector<Contradiction> found;
  std::array<std::string, kSignedCount> columns;
  for (std::size_t s = 0; s < kSignedCount; ++s) {
    const auto column = static_cast<Signed>(s);
    const bool blamed = std::any_of(solutions.begin(), solutions.end(),
                                    [&](unsigned flips) { return (flips & bit(column)) != 0U; });
    if (!blamed) continue;
    found.push_back(sign_contradiction(evidence, column));
    columns[s] = found.back().column;
  }
  if (solutions.size() == 1) return found;
  const std::string named = alternatives(columns, solutions);
  for (Contradiction& one : found) {
    one.message += fmt::format(" (correct only one of these: {})", named);
  }
  return found;
}

/// Detects a speed whose sign is opposite to that of the thrust.
std::optional<Contradiction> check_direction(const Evidence& evidence) {
  if (!evidence.has(LogChannel::kSpeed)) return std::nullopt;
  const auto ratio = robust_ratio(
      series(evidence.overlapping, [](const EvidenceWindow& w) { return w.thrust; }),
      series(evidence.overlapping, [](const EvidenceWindow& w) { return w.driven_m; }));
  if (!ratio || *ratio > 0.0) return std::nullopt;
  return Contradiction{"speed_mps",
                       "the speed and the sum of both forces have opposite signs: speed or forces "
                       "have the wrong sign (forward is positive)",
                       scaled_mapping(evidence, "speed_mps", -1.0)};
}

/// Shares of sum y^2 over the windows that the sum and the difference of the logged forces explain,
/// for a signal y such as the speed:
///
///     R^2 = (sum y s)^2 / (sum y^2 sum s^2)   for s = F'L + F'R, and for s = tau_diff, which is
///                                             proportional to F'R - F'L if the wheels are straight
struct SideShares {
  double of_sum = 0.0;
  double of_difference = 0.0;
  /// True: the signal y has the sign of F'R - F'L; false: the opposite sign.
  bool is_positive = true;

  bool follows_difference() const { return of_difference > 0.5 && of_difference > 3.0 * of_sum; }
};

template <class Y>
SideShares side_shares(const std::vector<EvidenceWindow>& windows, Y y_of) {
  double yy = 0.0, ss = 0.0, dd = 0.0, ys = 0.0, yd = 0.0;
  for (const EvidenceWindow& w : windows) {
    const double y = y_of(w) / w.span_s;
    yy += y * y;
    ss += w.thrust * w.thrust;
    dd += w.tau_diff_m * w.tau_diff_m;
    ys += y * w.thrust;
    yd += y * w.tau_diff_m;
  }
  const auto share = [yy](double yx, double xx) {
    return yy > 0.0 && xx > 0.0 ? yx * yx / (yy * xx) : 0.0;
  };
  return {share(ys, ss), share(yd, dd), yd > 0.0};
}

/// Detects a speed that is proportional to F'R - F'L instead of F'L + F'R. If heading or yaw rate
/// follow F'R - F'L as well, the forces are right and the speed is wrong. The speed then comes from
/// wheels of which one side is reversed, or from another column. Otherwise a force column has the
/// wrong sign, or, in a log with a yaw rate but no heading, wheel odometry with one side reversed
/// gives both speed and yaw rate.
std::optional<Contradiction> check_one_side(const Evidence& evidence) {
  constexpr std::size_t kMinSeconds = 10;
  if (!evidence.has(LogChannel::kSpeed) || evidence.windows.size() < kMinSeconds) {
    return std::nullopt;
  }
  const std::vector<EvidenceWindow>& windows = evidence.windows;
  const SideShares speed = side_shares(windows, [](const auto& w) { return w.driven_m; });
  if (!speed.follows_difference()) return std::nullopt;
  const std::string observed = fmt::format(
      "the speed is proportional to force_right - force_left (R^2 {:.2f}) instead of "
      "their sum ({:.2f})",
      speed.of_difference, speed.of_sum);
  const SideShares turn = side_shares(windows, [](const auto& w) { return w.turned_rad; });
  const SideShares rate = side_shares(windows, [](const auto& w) { return w.rate_rad; });
  constexpr std::string_view kReversed =
      "the speed comes from wheels of which one side is reversed, or its column is exchanged with "
      "that of the yaw rate";
  if (turn.follows_difference() || rate.follows_difference()) {
    return Contradiction{"speed_mps",
                         fmt::format("{}, and so is the turning (R^2 {:.2f}): {}", observed,
                                     std::max(turn.of_difference, rate.of_difference), kReversed),
                         "", "map the column of the vehicle's speed, forward positive"};
  }
  const std::string column = speed.is_positive ? "force_left" : "force_right";
  const std::string mapping = scaled_mapping(evidence, column, -1.0);
  const std::string wrong = "this column has the wrong sign; forward is positive on both sides";
  if (evidence.has(LogChannel::kHeading) || !evidence.has(LogChannel::kYawRate)) {
    return Contradiction{column, fmt::format("{}: {}", observed, wrong), mapping};
  }
  return Contradiction{column, fmt::format("{}: {}; or {}", observed, wrong, kReversed), mapping,
                       fmt::format("find out which column is wrong; if it is the force, map it "
                                   "with {}",
                                   option_text("column '" + mapping + "'"))};
}

/// Increase of the logged speed during rearward thrust, m/s, summed over all time spans with such
/// thrust. The increase in a span is the largest rise of the speed, averaged over 0.25 s, above an
/// earlier value. Leaves out the first half second of a span, because motors and sensors may lag.
double gathered_backwards_mps(const DrivingLog& log) {
  // Thrust counts as rearward if its magnitude is at least this fraction of the largest thrust.
  constexpr double kPushes = 0.1;
  constexpr double kLag_s = 0.5;
  constexpr double kMean_s = 0.25;
  const std::vector<double>& speed = log[LogChannel::kSpeed]->value;
  const auto thrust = [&](std::size_t row) { return log.force_left[row] + log.force_right[row]; };
  double most = 0.0;
  for (std::size_t row = 0; row < log.rows(); ++row) most = std::max(most, std::abs(thrust(row)));
  double gathered = 0.0;
  for (std::size_t begin = 0; begin < log.rows();) {
    std::size_t end = begin;
    while (end < log.rows() && thrust(end) < -kPushes * most) ++end;
    double least = std::numeric_limits<double>::infinity(), rise = 0.0;
    std::size_t row = begin;
    while (row < end && log.t_s[row] < log.t_s[begin] + kLag_s) ++row;
    while (row < end && log.t_s[end - 1] - log.t_s[row] >= kMean_s) {
      const double until_s = log.t_s[row] + kMean_s;
      double sum = 0.0, n = 0.0;
      for (; row < end && log.t_s[row] < until_s; ++row, n += 1.0) sum += speed[row];
      least = std::min(least, sum / n);
      rise = std::max(rise, sum / n - least);
    }
    gathered += rise;
    begin = std::max(end, begin + 1);
  }
  return gathered;
}

/// Detects a column of speeds that lack the sign: they are never negative, and rise during rearward
/// thrust. (Rearward thrust would slow down a vehicle that drives forward.)
std::optional<Contradiction> check_unsigned(const Evidence& evidence) {
  // A speed counts as negative if its magnitude is at least this fraction of the largest speed.
  constexpr double kNegative = 0.05;
  constexpr double kMuch = 0.15;
  if (!evidence.has(LogChannel::kSpeed)) return std::nullopt;
  const auto [slowest, fastest] = std::ranges::minmax(evidence.log[LogChannel::kSpeed]->value);
  if (!(fastest > 0.0) || slowest < -kNegative * fastest) return std::nullopt;
  const double gathered_mps = gathered_backwards_mps(evidence.log);
  if (gathered_mps < kMuch * fastest) return std::nullopt;
  return Contradiction{
      "speed_mps",
      fmt::format(
          "it is never negative, although the vehicle gains {:.3g} m/s during rearward thrust: the "
          "sensor does not measure the direction. Add the sign to the speed, leave the column out "
          "if positions are measured, or record forward driving only",
          gathered_mps),
      ""};
}

}  // namespace

std::vector<Contradiction> sign_contradictions(const Evidence& evidence) {
  // If the force of one side has the wrong sign, thrust and yaw moment are exchanged, and no other
  // sign can be checked.
  if (auto one_side = check_one_side(evidence)) return {*std::move(one_side)};
  std::vector<Contradiction> found;
  if (auto is_unsigned = check_unsigned(evidence)) found.push_back(*is_unsigned);
  if (auto direction = check_direction(evidence)) found.push_back(*direction);
  for (Contradiction& one : check_signs(evidence)) found.push_back(std::move(one));
  return found;
}

}  // namespace awmr
