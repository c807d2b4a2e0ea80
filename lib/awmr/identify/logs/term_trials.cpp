#include "awmr/identify/logs/term_trials.h"

#include <algorithm>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/units.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// Smallest interval, rad, that contains 0 and all steering commands of the window.
Interval commanded_angles_rad(const FitWindow& window) {
  const auto& [log, begin, end] = window.rows;
  if (!log->steering_command_rad) return {0.0, 0.0};
  const auto [least, most] =
      std::ranges::minmax(std::span(*log->steering_command_rad).subspan(begin, end - begin));
  return {std::min(0.0, least), std::max(0.0, most)};
}

/// Largest steering rate, rad/s, that the commands demand of the servo: the range of the steering
/// commands divided by the servo's time constant, at most the rate limit of the vehicle file.
/// Returns 0 if the time constant is not free.
double demanded_rate_radps(const NoiseIteration& settled) {
  const LogModel& model = settled.problem.model;
  const auto lag = place_of(model.quantities, ParameterId::kSteeringTimeConstant);
  if (!lag) return 0.0;
  Interval commands{0.0, 0.0};
  for (const FitWindow& window : settled.problem.windows) {
    const Interval angles = commanded_angles_rad(window);
    commands = {std::min(commands.lo, angles.lo), std::max(commands.hi, angles.hi)};
  }
  const double lag_s = model.quantities[*lag].value(settled.point.coordinates[*lag]);
  return std::min((commands.hi - commands.lo) / lag_s,
                  radians(model.vehicle.steering_max_rate_degps));
}

/// Returns a fit in which a rate limit of the servo shows most clearly. For long logs, this is a
/// new fit of the windows with the largest ranges of steering commands; for short logs, it is
/// `settled`.
NoiseIteration with_largest_steering(const NoiseIteration& settled) {
  if (!is_long(settled.problem)) return settled;
  const std::vector<FitWindow>& windows = settled.problem.windows;
  std::vector<std::pair<double, std::size_t>> by_range;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const Interval angles = commanded_angles_rad(windows[w]);
    by_range.emplace_back(angles.hi - angles.lo, w);
  }
  std::ranges::stable_sort(by_range, std::greater{}, &std::pair<double, std::size_t>::first);
  std::vector<std::size_t> largest;
  for (std::size_t i = 0; i < kSampleWindows; ++i) largest.push_back(by_range[i].second);
  std::ranges::sort(largest);
  return settle_noise(with_windows(settled.problem, largest),
                      with_windows(settled.problem, settled.point, largest),
                      {.most = 1, .is_near = true});
}

}  // namespace

double akaike_of(const NoiseIteration& fit) {
  double aic = 2.0 * static_cast<double>(fit.problem.model.quantities.size());
  for (const auto& [channel, level] : fit.problem.model.noise) {
    aic += level.cost + 2.0 * level.numbers();
  }
  return aic + fit.change_cost;
}

NoiseIteration tried(const NoiseIteration& settled, const std::vector<FreeTerm>& more) {
  constexpr double kLargestFirstStep = 3.0;  // limit of an initial guess, in large changes
  std::vector<FreeQuantity> quantities;
  std::vector<double> begin;
  for (const FreeTerm& term : more) {
    quantities.push_back(term.quantity);
    const double most = kLargestFirstStep * term.quantity.large_change;
    begin.push_back(term.quantity.is_form() ? term.begin : std::clamp(term.begin, -most, most));
  }
  Extended from = extended(with_white_noise(settled.problem), settled.point, quantities, begin);
  if (has_force_excess(quantities)) {
    from.problem.model.longest_step_s = step_s_at(from.problem.model, from.point.coordinates);
  }
  return settle_noise(std::move(from.problem), std::move(from.point), {.most = 1});
}

NoiseIteration start_of_trials(NoiseIteration settled) {
  settled.point = settle_noise(with_white_noise(settled.problem), settled.point, {.most = 1}).point;
  return settled;
}

std::optional<NoiseIteration> settled_if_better(const NoiseIteration& settled, Extended from) {
  NoiseIteration fit = settle_noise(std::move(from.problem), std::move(from.point));
  if (!(akaike_of(settled) - akaike_of(fit) > kTermAicThreshold)) return std::nullopt;
  return fit;
}

bool has_motor_lag(const LogModel& model) {
  return model.vehicle.motor_time_constant_s || has(model.quantities, Kind::kMotorLag);
}

std::optional<NoiseIteration> with_motor_lag_for_filters(const NoiseIteration& settled) {
  LogProblem problem = settled.problem;
  SearchPoint point = settled.point;
  if (has_motor_lag(problem.model)) return std::nullopt;
  std::vector<double> lags_s;
  for (std::size_t i = problem.model.quantities.size(); i-- > 0;) {
    const Kind kind = problem.model.quantities[i].kind;
    if (kind != Kind::kSensorLag && kind != Kind::kLagDamping) continue;
    if (kind == Kind::kSensorLag) lags_s.push_back(point.coordinates[i]);
    const auto at_i = static_cast<std::ptrdiff_t>(i);
    problem.model.quantities.erase(problem.model.quantities.begin() + at_i);
    problem.initial.erase(problem.initial.begin() + at_i);
    problem.bounds.erase(problem.bounds.begin() + at_i);
    point.coordinates.erase(point.coordinates.begin() + at_i);
  }
  if (lags_s.size() < 2) return std::nullopt;
  Extended from = extended(with_white_noise(std::move(problem)), std::move(point),
                           {free_term(Kind::kMotorLag)}, {std::ranges::min(lags_s)});
  NoiseIteration fit = settle_noise(std::move(from.problem), std::move(from.point));
  if (!(akaike_of(fit) < akaike_of(settled))) return std::nullopt;
  return fit;
}

std::optional<NoiseIteration> with_motor_lag_and_delay(const NoiseIteration& settled) {
  constexpr double kShare = 0.5;  // initial guess of the motor lag, divided by the fitted delay
  const std::vector<FreeQuantity>& quantities = settled.problem.model.quantities;
  const auto delay = std::ranges::find(quantities, Kind::kDelay, &FreeQuantity::kind);
  if (delay == quantities.end() || has_motor_lag(settled.problem.model)) return {};
  const std::size_t place = at(delay - quantities.begin());
  const double lag_s = kShare * settled.point.coordinates[place];
  if (!(lag_s > 0.0)) return {};
  NoiseIteration from = settled;
  from.point.coordinates[place] -= lag_s;
  NoiseIteration lagged = tried(from, {{free_term(Kind::kMotorLag), lag_s}});
  if (!(akaike_of(lagged) < akaike_of(settled))) return {};
  return settled_if_better(settled, {std::move(lagged.problem), std::move(lagged.point)});
}

std::optional<NoiseIteration> with_slower_servo(const NoiseIteration& settled) {
  if (has(settled.problem.model.quantities, Kind::kServoRate)) return {};
  const double demanded_radps = demanded_rate_radps(settled);
  if (!(demanded_radps > 0.0)) return {};
  const NoiseIteration without = with_largest_steering(settled);
  LowestAic lowest(without);
  for (const double share : {0.6, 0.25}) {
    const double begin_radps = share * demanded_radps;
    lowest.consider(tried(without, {{servo_rate(begin_radps), begin_radps}}));
  }
  if (!lowest.best()) return {};
  NoiseIteration& limited = *lowest.best();
  Extended from =
      extended(settled.problem, settled.point, {limited.problem.model.quantities.back()},
               {limited.problem.initial.back()});
  from.point.coordinates = std::move(limited.point.coordinates);
  return settled_if_better(settled, std::move(from));
}

}  // namespace awmr
