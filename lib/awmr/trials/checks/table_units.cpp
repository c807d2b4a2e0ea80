#include "table_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/model/plausibility.h"

namespace awmr {
namespace {

/// Units by the ratio of the printed value to the one computed from distance or turns and time.
constexpr std::array<ColumnUnit, 7> kTableSpeedUnits{
    {{3.6, "speed_mps", 1.0 / 3.6, "the speed looks like km/h"},
     {2.23694, "speed_mps", 0.44704, "the speed looks like miles per hour"},
     {100.0, "speed_mps", 1e-2, "the speed looks like cm/s"},
     {1000.0, "speed_mps", 1e-3, "the speed looks like mm/s"},
     {1000.0, "elapsed_s", 1e-3, "the time looks like milliseconds"},
     {1e-2, "distance_m", 1e-2, "the distance looks like cm"},
     {1e-3, "distance_m", 1e-3, "the distance looks like mm"}}};
constexpr std::array<ColumnUnit, 2> kTableTurnUnits{
    {{57.29578, "yaw_rate_radps", 1.0 / 57.29578, "the yaw rate looks like degrees per second"},
     {1000.0, "elapsed_s", 1e-3, "the time looks like milliseconds"}}};

constexpr Interval kLengthsPerSecond{0.02, 100.0};  // from a crawl to a racing model
constexpr double kUsualLengthsPerSecond = 20.0;
constexpr double kSlowTable_radps = 0.01;  // smallest plausible yaw rate of the fastest turn
/// From the best bearings to locked racing tyres.
constexpr Interval kMeanDeceleration_mps2{0.01, 20.0};

/// Finds the unit of a column from `ratios`, the printed values divided by the timed values: the
/// unit whose `times` differs from every ratio by less than 10 %. Null without such a unit, or with
/// fewer than two ratios.
template <std::size_t N>
const ColumnUnit* unit_of(const std::vector<double>& ratios,
                          const std::array<ColumnUnit, N>& units) {
  for (const ColumnUnit& unit : units) {
    const bool all = std::all_of(ratios.begin(), ratios.end(), [&](double ratio) {
      return std::abs(ratio / unit.times - 1.0) < 0.1;
    });
    if (all && ratios.size() >= 2) return &unit;
  }
  return nullptr;
}

/// A correction that makes values smaller, and its reason for messages.
struct Smaller {
  double factor;  ///< corrected value = value in the file times this, < 1
  std::string_view words;
};

/// Selects the more plausible of two corrections, by 1/100 or by 1/1000: the correction that brings
/// the speed of the fastest run nearer to a common value, three vehicle lengths per second.
Smaller smaller_unit(double lengths_per_second, Smaller hundredth, Smaller thousandth) {
  constexpr double kCommon = 3.0;
  const auto apart = [&](const Smaller& unit) {
    return std::abs(std::log(lengths_per_second * unit.factor / kCommon));
  };
  return apart(hundredth) <= apart(thousandth) ? hundredth : thousandth;
}

/// True if the vehicle's dimensions are plausible, so that speeds can be compared with its length.
bool tells_lengths(const Vehicle& vehicle) { return implausible_values(vehicle).empty(); }

template <class Row>
double fastest(const std::vector<Row>& rows, double Row::*rate) {
  double most = 0.0;
  for (const Row& row : rows) most = std::max(most, row.*rate);
  return most;
}

/// Ratios of the printed rate to the timed one, unit * amount/elapsed_s, in rows that have both.
template <class Row>
std::vector<double> printed_over_timed(const std::vector<Row>& rows, double Row::*printed,
                                       std::optional<double> Row::*amount, double unit) {
  std::vector<double> ratios;
  for (const Row& row : rows) {
    if (!(row.*amount) || !row.elapsed_s) continue;
    ratios.push_back(row.*printed * *row.elapsed_s / (unit * *(row.*amount)));
  }
  return ratios;
}

/// Upper bound of the vehicle's speed u at full thrust, with a margin of 30 %. Extrapolates from
/// the fastest surge run, with the speed u_run at the thrust tau_run, to the full thrust tau:
/// tau/tau_run = (u/u_run)^b. b is 1/2, because the resistance grows at least with the square root
/// of the speed. Empty if that run used less than half of the full thrust, because static friction
/// then dominates.
std::optional<double> top_speed_mps(const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle) {
  constexpr double kRoom = 1.3;
  if (!surge || surge->rows.empty() || wrong_unit(*surge, vehicle)) return std::nullopt;
  const auto fastest_run = std::ranges::max_element(surge->rows, {}, &SurgeRow::speed_mps);
  const double share = fastest_run->tau_speed / (vehicle.driven_wheels() * vehicle.wheel_force.hi);
  if (share < 0.5) return std::nullopt;
  return kRoom * fastest_run->speed_mps / std::min(1.0, share * share);
}

/// Likely unit of a speed above the vehicle's top speed: the first unit whose correction gives a
/// speed below it.
Smaller unit_below(double speed_mps, double top_mps) {
  constexpr Smaller kUnits[] = {{1.0 / 3.6, "the speed looks like km/h"},
                                {1e-2, "the speed looks like cm/s"},
                                {1e-3, "the speed looks like mm/s"}};
  constexpr double kMph = 0.44704;
  if (speed_mps * kMph <= top_mps) {
    return {kUnits[0].factor, "the speed looks like km/h, or like mph (factor 0.44704)"};
  }
  for (const Smaller& unit : kUnits) {
    if (speed_mps * unit.factor <= top_mps) return unit;
  }
  return kUnits[2];
}

/// Builds the result for a column with one likely unit, which `factor` corrects.
WrongUnit wrong(int line, std::string message, std::string_view column, double factor) {
  return {line, std::move(message), {{"", column, factor}}};
}

std::string lengths_text(double speed_mps, const Vehicle& vehicle) {
  return fmt::format("the fastest run reaches {:.3g} m/s, {:.3g} vehicle lengths per second",
                     speed_mps, speed_mps / vehicle.length_m);
}

}  // namespace

std::optional<WrongUnit> wrong_unit(const TrialSet<SurgeRow>& surge, const Vehicle& vehicle) {
  if (surge.rows.empty()) return std::nullopt;
  const SurgeRow& first = surge.rows.front();
  const std::vector<double> ratios =
      printed_over_timed(surge.rows, &SurgeRow::speed_mps, &SurgeRow::distance_m, 1.0);
  const double speed_mps = fastest(surge.rows, &SurgeRow::speed_mps);
  const double lengths = speed_mps / vehicle.length_m;
  if (const ColumnUnit* unit = unit_of(ratios, kTableSpeedUnits)) {
    // A speed in mm/s and a time in milliseconds both give the ratio 1000. If the printed speed is
    // usual for the vehicle's length, the time is wrong.
    const bool is_time = unit->times == 1000.0 && lengths <= kUsualLengthsPerSecond;
    if (is_time) unit = &kTableSpeedUnits[4];
    return wrong(first.line,
                 fmt::format("speed_mps is {:.3g} times distance_m/elapsed_s: {}", median(ratios),
                             unit->words),
                 unit->column, unit->factor);
  }
  if (kLengthsPerSecond.contains(lengths) || !tells_lengths(vehicle)) return std::nullopt;
  const bool is_timed = !ratios.empty();
  const std::string described = lengths_text(speed_mps, vehicle);
  if (lengths > kLengthsPerSecond.hi) {
    const auto [factor, words] = is_timed
                                     ? smaller_unit(lengths, {1e-2, "the distance looks like cm"},
                                                    {1e-3, "the distance looks like mm"})
                                     : smaller_unit(lengths, {1e-2, "the speed looks like cm/s"},
                                                    {1e-3, "the speed looks like mm/s"});
    return wrong(first.line, fmt::format("{}: {}", described, words),
                 is_timed ? "distance_m" : "speed_mps", factor);
  }
  if (!is_timed) return std::nullopt;
  return wrong(first.line, described + ": the time looks like milliseconds", "elapsed_s", 1e-3);
}

std::optional<WrongUnit> wrong_unit(const TrialSet<TurningRow>& turning) {
  if (turning.rows.empty()) return std::nullopt;
  const TurningRow& first = turning.rows.front();
  const std::vector<double> ratios = printed_over_timed(turning.rows, &TurningRow::yaw_rate_radps,
                                                        &TurningRow::turns, 2.0 * pi<double>());
  if (const ColumnUnit* unit = unit_of(ratios, kTableTurnUnits)) {
    return wrong(first.line,
                 fmt::format("yaw_rate_radps is {:.3g} times 2 pi turns/elapsed_s: {}",
                             median(ratios), unit->words),
                 unit->column, unit->factor);
  }
  const double rate_radps = fastest(turning.rows, &TurningRow::yaw_rate_radps);
  const std::string described = fmt::format("the fastest turn is {:.3g} rad/s", rate_radps);
  if (rate_radps >= kSlowTable_radps || ratios.empty()) return std::nullopt;
  return wrong(first.line, described + ": the time looks like milliseconds", "elapsed_s", 1e-3);
}

namespace {

/// Values of a coast-down file that must be plausible if its units are right.
struct Coasts {
  int line;                    ///< number of the first line with data
  double fastest_mps;          ///< highest initial speed
  Interval deceleration_mps2;  ///< mean decelerations, from the gentlest to the hardest stop
  const char* speed;           ///< name of the speed column
  const char* time;            ///< name of the time column
};

void include(double value, Interval& range) {
  range = {std::min(range.lo, value), std::max(range.hi, value)};
}

std::optional<WrongUnit> wrong_unit(const Coasts& coasts,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle) {
  const double lengths = coasts.fastest_mps / vehicle.length_m;
  if (lengths > kLengthsPerSecond.hi && tells_lengths(vehicle)) {
    const auto [factor, words] = smaller_unit(lengths, {1e-2, "the speed looks like cm/s"},
                                              {1e-3, "the speed looks like mm/s"});
    return wrong(coasts.line,
                 fmt::format("{}: {}", lengths_text(coasts.fastest_mps, vehicle), words),
                 coasts.speed, factor);
  }
  const auto top_mps = top_speed_mps(surge, vehicle);
  if (top_mps && coasts.fastest_mps > *top_mps) {
    const auto [factor, words] = unit_below(coasts.fastest_mps, *top_mps);
    return wrong(coasts.line,
                 fmt::format("a coast-down begins at {:.3g} m/s, but according to the surge runs "
                             "the vehicle reaches at most {:.3g} m/s: {}",
                             coasts.fastest_mps, *top_mps, words),
                 coasts.speed, factor);
  }
  const auto [gentlest_mps2, hardest_mps2] = coasts.deceleration_mps2;
  if (hardest_mps2 < kMeanDeceleration_mps2.lo) {
    return wrong(coasts.line,
                 fmt::format("the hardest stop decelerates with only {:.3g} m/s^2: the time looks "
                             "like milliseconds",
                             hardest_mps2),
                 coasts.time, 1e-3);
  }
  if (gentlest_mps2 > kMeanDeceleration_mps2.hi) {
    return wrong(coasts.line,
                 fmt::format("every stop decelerates with {:.3g} m/s^2 or more, beyond the grip of "
                             "any tyre: the time looks like minutes",
                             gentlest_mps2),
                 coasts.time, 60.0);
  }
  return std::nullopt;
}

}  // namespace

std::optional<WrongUnit> wrong_unit(const TrialSet<StopTimeRow>& coastdown,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle) {
  if (coastdown.rows.empty()) return std::nullopt;
  Interval deceleration_mps2{std::numeric_limits<double>::infinity(), 0.0};
  for (const StopTimeRow& row : coastdown.rows) {
    include(row.initial_speed_mps / row.stop_time_s, deceleration_mps2);
  }
  return wrong_unit(
      {coastdown.rows.front().line, fastest(coastdown.rows, &StopTimeRow::initial_speed_mps),
       deceleration_mps2, "initial_speed_mps", "stop_time_s"},
      surge, vehicle);
}

std::optional<WrongUnit> wrong_unit(const std::vector<CoastCurve>& curves,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle) {
  if (curves.empty()) return std::nullopt;
  double fastest_mps = 0.0;
  Interval deceleration_mps2{std::numeric_limits<double>::infinity(), 0.0};
  for (const CoastCurve& curve : curves) {
    const auto [least, most] = std::ranges::minmax(curve.speed_mps);
    fastest_mps = std::max(fastest_mps, curve.speed_mps.front());
    include((most - least) / (curve.t_s.back() - curve.t_s.front()), deceleration_mps2);
  }
  // Skips curves without any change of speed, because the fit does not use them.
  if (!(deceleration_mps2.hi > 0.0)) return std::nullopt;
  const bool of_bins = curves.front().of_bins;
  return wrong_unit({curves.front().line, fastest_mps, deceleration_mps2,
                     of_bins ? "from_mps" : "speed_mps", of_bins ? "elapsed_s" : "t_s"},
                    surge, vehicle);
}

}  // namespace awmr
