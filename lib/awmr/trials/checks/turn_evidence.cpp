#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/text.h"
#include "awmr/core/units.h"
#include "awmr/model/plausibility.h"
#include "force_units.h"
#include "table_units.h"

namespace awmr {
namespace {

/// Largest accepted ratio of the yaw rate to that of rolling wheels. In a turn, wheels roll no
/// faster than straight ahead with the same force, and the wheelbase is longer than l_f. Steered
/// turns: 3, because the vehicle may drift, or steer its rear wheels in addition to the front
/// wheels. Differential turns: 4, because two interpolated speeds determine the limit, which makes
/// it less certain.
constexpr double kMaxSteered = 3.0;
constexpr double kMaxBySides = 4.0;
/// Smallest accepted ratio of the yaw rate to that of rolling wheels, for the row with the largest
/// ratio. Real turns have ratios several times larger, even with a wheelbase of five times l_f and
/// strong understeer.
constexpr double kMinSteered = 0.01;
constexpr double kMaxAcceleration_mps2 = 60.0;  // 6 g, twice that of a spinning model car
constexpr double kFastestTurn_radps = 25.0;     // four turns per second

/// Usual range of the ratio of the yaw rate to that of rolling wheels if the unit is right. The
/// message suggests only units that bring the largest ratio into this range.
constexpr Interval kPossibleShare{0.03, 2.5};
constexpr double kPossibleAcceleration_mps2 = 15.0;

constexpr std::array<ColumnUnit, 4> kPrintedUnits{
    {{57.29578, "yaw_rate_radps", 1.0 / 57.29578, "degrees per second"},
     {9.549297, "yaw_rate_radps", 1.0 / 9.549297, "turns per minute"},
     {57295.78, "yaw_rate_radps", 1.0 / 57295.78, "thousandths of a degree per second"},
     {1.0 / 57.29578, "yaw_rate_radps", 57.29578,
      "radians per second that were multiplied by pi/180 "
      "by mistake"}}};
constexpr std::array<ColumnUnit, 4> kTimedUnits{
    {{360.0, "turns", 1.0 / 360.0, "turns in degrees"},
     {60.0, "elapsed_s", 60.0, "a time in minutes"},
     {6.283185, "turns", 1.0 / 6.283185, "turns in radians"},
     {1e-3, "elapsed_s", 1e-3, "a time in milliseconds"}}};

/// Yaw rate of one row compared with a limit.
struct TurnShare {
  const TurningRow* row;
  double share;           ///< yaw rate divided by its limit
  std::string described;  ///< the comparison as text, for messages
};

/// Speed u as a function of tau_speed: piecewise linear through the origin and the surge runs,
/// never decreasing.
class SpeedCurve {
 public:
  explicit SpeedCurve(const std::vector<SurgeRow>& rows) {
    for (const SurgeRow& row : rows) points_.emplace_back(row.tau_speed, row.speed_mps);
    std::ranges::sort(points_);
    double most = 0.0;
    for (auto& [tau, speed] : points_) most = speed = std::max(most, speed);
  }
  /// u at the thrust tau, m/s; odd in tau. Above the largest tau_speed of the runs, u grows in
  /// proportion to tau^2: an upper bound, because resistance grows at least with the square root of
  /// the speed. Empty above 1.5 times the largest tau_speed.
  std::optional<double> at(double tau) const {
    if (tau < 0.0) {
      const auto forwards = at(-tau);
      return forwards ? std::optional(-*forwards) : std::nullopt;
    }
    const auto [top_tau, top_speed] = points_.back();
    if (tau > 1.5 * top_tau) return std::nullopt;
    if (tau > top_tau) return top_speed * (tau / top_tau) * (tau / top_tau);
    std::pair<double, double> below{0.0, 0.0};
    for (const auto& above : points_) {
      if (above.first < tau) {
        below = above;
        continue;
      }
      const double width = above.first - below.first;
      if (width <= 0.0) return above.second;
      return below.second + (above.second - below.second) * (tau - below.first) / width;
    }
    return top_speed;
  }

 private:
  std::vector<std::pair<double, double>> points_;
};

double largest_force(const TurningRow& row) {
  if (!row.sides) return row.wheel_force;
  return std::max(std::abs(row.sides->left), std::abs(row.sides->right));
}

/// Largest wheel force of all rows.
template <class Rows>
double hardest(const Rows& rows) {
  double most = 0.0;
  for (const TurningRow& row : rows) most = std::max(most, largest_force(row));
  return most;
}

/// Speed curve from the surge runs; empty if a unit of the surge runs is wrong, or if surge and
/// turning runs have different units of force.
std::optional<SpeedCurve> speed_curve(const TrialSet<TurningRow>& turning,
                                      const std::optional<TrialSet<SurgeRow>>& surge,
                                      const Vehicle& vehicle) {
  if (!surge || surge->rows.empty() || wrong_unit(*surge, vehicle)) return std::nullopt;
  const double limit = kForceRounding * vehicle.wheel_force.hi;
  double thrust = 0.0;
  for (const SurgeRow& row : surge->rows) thrust = std::max(thrust, row.tau_speed);
  const bool surge_beyond = thrust > vehicle.driven_wheels() * limit;
  const bool turns_beyond = std::max(hardest(turning.rows), hardest(turning.by_sides)) > limit;
  // If both tables have the same unit of force, the curve is usable even if that unit is wrong
  // (such as PWM counts instead of F').
  const bool is_same =
      surge_beyond == turns_beyond && (!surge_beyond || surge->force_column == "wheel_force");
  return is_same ? std::optional<SpeedCurve>(surge->rows) : std::nullopt;
}

std::string turn_text(const TurningRow& row) {
  if (!row.sides) {
    return fmt::format("{:.3g} rad/s with {:.3g} deg of steering", row.yaw_rate_radps,
                       degrees(row.steering_rad));
  }
  return fmt::format("{:.3g} rad/s with a force difference of {:.3g}", row.yaw_rate_radps,
                     row.sides->right - row.sides->left);
}

/// Yaw rate of a steered turn, divided by that of rolling wheels, u tan(d_r)/l_f. Empty if u is
/// unknown.
std::optional<TurnShare> steered_share(const TurningRow& row, const SpeedCurve& speed,
                                       const Vehicle& vehicle) {
  const auto u = speed.at(vehicle.driven_wheels() * row.wheel_force);
  if (!u || !(*u > 0.0) || row.steering_rad == 0.0) return std::nullopt;
  const double most = *u * std::tan(row.steering_rad) / vehicle.front_axle_m;
  return TurnShare{&row, row.yaw_rate_radps / most,
                   fmt::format("but rolling wheels at the {:.3g} m/s of the surge runs with this "
                               "force turn the vehicle at {:.3g} rad/s (u "
                               "tan(steering)/front_axle_m)",
                               *u, most)};
}

/// Yaw rate of a differential turn, divided by that of rolling wheels, (u(n F'R) - u(n F'L))/(2 d).
/// Empty if one of the speeds is unknown. Scatter of the surge runs may make the curve u(tau) too
/// flat between the two forces, so the slope there counts as at least half of the mean slope from
/// the origin.
std::optional<TurnShare> side_share(const TurningRow& row, const SpeedCurve& speed,
                                    const Vehicle& vehicle) {
  const int n = vehicle.driven_wheels();
  const auto left = speed.at(n * row.sides->left);
  const auto right = speed.at(n * row.sides->right);
  if (!left || !right) return std::nullopt;
  const double apart = row.sides->right - row.sides->left;
  const double chord = std::max(std::abs(*left), std::abs(*right)) * apart / largest_force(row);
  const double difference = std::max(*right - *left, 0.5 * chord);
  if (!(difference > 0.0)) return std::nullopt;
  const double most = difference / (2.0 * vehicle.half_track_m);
  return TurnShare{
      &row, row.yaw_rate_radps / most,
      fmt::format("but according to the surge runs, wheels that roll without slip would differ by "
                  "{:.3g} m/s between left and right, and turn the vehicle at this difference/(2 "
                  "half_track_m) = {:.3g} rad/s",
                  difference, most)};
}

/// Yaw rate of a steered turn, divided by the limit by grip. The turning radius R is at least
/// l_f/tan(d_r), so the centripetal acceleration r^2 R is at least r^2 l_f/tan(d_r).
TurnShare grip_share(const TurningRow& row, const Vehicle& vehicle) {
  const double radius_m = vehicle.front_axle_m / std::tan(row.steering_rad);
  const double most = std::sqrt(kMaxAcceleration_mps2 / radius_m);
  return {&row, row.yaw_rate_radps / most,
          fmt::format("a lateral acceleration of at least {:.3g} m/s^2 (r^2 "
                      "front_axle_m/tan(steering), on the smallest possible circle), while grip "
                      "allows at most {:g} m/s^2",
                      row.yaw_rate_radps * row.yaw_rate_radps * radius_m, kMaxAcceleration_mps2)};
}

/// A limit of the yaw rate, and the rows that are compared with it.
struct TurnCriterion {
  std::vector<TurnShare> shares;
  double most;        ///< largest accepted ratio of yaw rate to limit
  double least;       ///< smallest accepted value of the largest ratio in the table; 0: any
  Interval possible;  ///< usual ratios in the right unit
};

std::vector<TurnCriterion> criteria_of(const TrialSet<TurningRow>& turning,
                                       const std::optional<SpeedCurve>& speed,
                                       const Vehicle& vehicle) {
  TurnCriterion steered{{}, kMaxSteered, kMinSteered, kPossibleShare};
  TurnCriterion by_sides{{}, kMaxBySides, 0.0, kPossibleShare};
  const Interval grip{0.003, std::sqrt(kPossibleAcceleration_mps2 / kMaxAcceleration_mps2)};
  TurnCriterion circle{{}, 1.0, 0.0, grip};
  TurnCriterion any{{}, 1.0, 0.0, {0.0005, 0.5}};
  for (const auto* rows : {&turning.rows, &turning.by_sides}) {
    for (const TurningRow& row : *rows) {
      auto& rolled = row.sides ? by_sides : steered;
      const auto share = !speed      ? std::nullopt
                         : row.sides ? side_share(row, *speed, vehicle)
                                     : steered_share(row, *speed, vehicle);
      if (share) rolled.shares.push_back(*share);
      if (!row.sides && row.steering_rad > 0.0) {
        circle.shares.push_back(grip_share(row, vehicle));
      }
      any.shares.push_back({&row, row.yaw_rate_radps / kFastestTurn_radps,
                            fmt::format("faster than {:g} rad/s", kFastestTurn_radps)});
    }
  }
  // If the dimensions in the vehicle file are implausible, checks only the limit of 25 rad/s, which
  // does not depend on the dimensions.
  if (!implausible_values(vehicle).empty()) return {std::move(any)};
  return {std::move(steered), std::move(by_sides), std::move(circle), std::move(any)};
}

/// Returns the corrections of the unit that bring `share`, a ratio of yaw rate to limit, into the
/// range `possible`. `is_printed`: the yaw rate was read from yaw_rate_radps, not computed from the
/// number of turns and the time. The two have different units in which they may be wrong.
std::vector<UnitFix> turn_unit_fixes(double share, const Interval& possible, bool is_printed) {
  const bool is_fast = share > possible.hi;
  std::vector<UnitFix> found;
  for (const ColumnUnit& unit : is_printed ? std::span(kPrintedUnits) : std::span(kTimedUnits)) {
    if ((unit.times > 1.0) != is_fast || !possible.contains(share / unit.times)) continue;
    found.push_back({std::string(unit.words), unit.column, unit.factor});
  }
  return found;
}

WrongUnit wrong_column(const TurnShare& worst, const TurnCriterion& criterion, bool is_printed,
                       int line) {
  std::vector<UnitFix> unit_fixes = turn_unit_fixes(worst.share, criterion.possible, is_printed);
  const std::string described = fmt::format("line {} turns at {}, {}", worst.row->line,
                                            turn_text(*worst.row), worst.described);
  if (unit_fixes.empty()) {
    return {line,
            described,
            {},
            "correct the yaw rates, or the forces, steering angles and "
            "vehicle sizes with which they are compared"};
  }
  const std::string_view what = is_printed ? "the yaw rates look like" : "this looks like";
  const auto words = [](const UnitFix& unit_fix) { return unit_fix.words; };
  return {line, fmt::format("{}: {} {}", described, what, enumerated(unit_fixes, words, " or ")),
          unit_fixes};
}

/// Reports single rows that exceed the limit in a table in which most rows do not.
WrongUnit wrong_rows(const std::vector<TurnShare>& shares, double most) {
  std::vector<int> lines;
  for (const TurnShare& one : shares) {
    if (one.share > most) lines.push_back(one.row->line);
  }
  std::ranges::sort(lines);
  const TurnShare& worst = shares.back();
  return {lines.front(),
          fmt::format("line {} turns at {}, {}; most rows are within this limit", worst.row->line,
                      turn_text(*worst.row), worst.described),
          {},
          fmt::format("correct line{} {}", lines.size() == 1 ? "" : "s", fmt::join(lines, ", "))};
}

/// Returns the column or the rows that violate a criterion; empty if none does.
std::optional<WrongUnit> wrong_by(TurnCriterion criterion, bool is_printed) {
  constexpr double kApart = 10.0;
  std::vector<TurnShare>& shares = criterion.shares;
  if (shares.empty()) return std::nullopt;
  int line = shares.front().row->line;
  for (const TurnShare& one : shares) line = std::min(line, one.row->line);
  std::ranges::stable_sort(shares, {}, &TurnShare::share);
  const TurnShare& middle = shares[shares.size() / 2];
  const TurnShare& largest = shares.back();
  if (largest.share < criterion.least) return wrong_column(largest, criterion, is_printed, line);
  if (largest.share <= criterion.most) return std::nullopt;
  const bool is_apart = middle.share <= criterion.most && largest.share > kApart * middle.share;
  if (is_apart) return wrong_rows(shares, criterion.most);
  return wrong_column(largest, criterion, is_printed, line);
}

}  // namespace

std::optional<WrongUnit> wrong_turn(const TrialSet<TurningRow>& turning,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle) {
  const bool is_printed = turning.rate_column == "yaw_rate_radps";
  for (TurnCriterion& criterion :
       criteria_of(turning, speed_curve(turning, surge, vehicle), vehicle)) {
    if (auto wrong = wrong_by(std::move(criterion), is_printed)) return wrong;
  }
  return std::nullopt;
}

}  // namespace awmr
