#include "awmr/identify/logs/choice/term_trials.h"

#include <algorithm>
#include <functional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/units.h"
#include "awmr/identify/logs/choice/further_terms.h"
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

/// A short fit (one round) of only these windows (indices) of `settled`.
NoiseIteration with_some_windows(const NoiseIteration& settled,
                                 const std::vector<std::size_t>& windows) {
  return settle_noise(with_windows(settled.problem, windows),
                      with_windows(settled.problem, settled.point, windows),
                      {.most = 1, .is_near = true});
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
  return with_some_windows(settled, largest);
}

}  // namespace

double akaike_of(const NoiseIteration& fit) {
  double aic = 2.0 * static_cast<double>(fit.problem.model.quantities.size());
  for (const auto& [sensor, level] : fit.problem.model.noise) {
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

NoiseIteration sample_of(const NoiseIteration& settled) {
  const std::vector<FitWindow>& windows = settled.problem.windows;
  const std::vector<std::size_t> even = spread(windows.size(), kSampleWindows);
  std::set<std::size_t> sample(even.begin(), even.end());
  for (std::size_t w = 1; w < windows.size(); ++w) {
    if (windows[w].rows.log != windows[w - 1].rows.log) sample.insert(w);
  }
  return with_some_windows(settled, {sample.begin(), sample.end()});
}

NoiseIteration with_all_windows(const NoiseIteration& settled, const NoiseIteration& found) {
  NoiseIteration all = settled;
  all.problem.model.quantities = found.problem.model.quantities;
  all.problem.model.longest_step_s = found.problem.model.longest_step_s;
  all.problem.initial = found.problem.initial;
  all.problem.bounds = found.problem.bounds;
  all.point.coordinates = found.point.coordinates;
  return all;
}

std::optional<NoiseIteration> settled_if_better(const NoiseIteration& settled, Extended from) {
  NoiseIteration fit = settle_noise(std::move(from.problem), std::move(from.point));
  if (!(akaike_of(settled) - akaike_of(fit) > kTermAicThreshold)) return std::nullopt;
  return fit;
}

bool has_motor_lag(const LogModel& model) {
  return model.vehicle.motor_time_constant_s || has(model.quantities, Kind::kMotorLag);
}

namespace {

/// A sensor's low-pass filter in a fit.
struct FoundFilter {
  LogChannel channel;
  double lag_s;    ///< time constant T
  double delay_s;  ///< delay of slow signals: 2 zeta T; T for a filter of first order
};

std::vector<FoundFilter> filters_of(const NoiseIteration& fit) {
  const std::vector<FreeQuantity>& quantities = fit.problem.model.quantities;
  std::vector<FoundFilter> filters;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (quantities[i].kind != Kind::kSensorLag) continue;
    const LogChannel channel = quantities[i].channel;
    const double lag_s = fit.point.coordinates[i];
    const auto damping = place_of(quantities, free_term(Kind::kLagDamping, channel).name());
    const double delays = damping ? 2.0 * fit.point.coordinates[*damping] : 1.0;
    filters.push_back({channel, lag_s, delays * lag_s});
  }
  return filters;
}

/// The fit `settled` with the terms `others` in place of these filters.
NoiseIteration replaced(const NoiseIteration& settled, const std::vector<FoundFilter>& filters,
                        const std::vector<FreeTerm>& others) {
  LogProblem problem = with_white_noise(settled.problem);
  SearchPoint point = settled.point;
  const auto is_replaced = [&](const FreeQuantity& q) {
    return (q.kind == Kind::kSensorLag || q.kind == Kind::kLagDamping) &&
           std::ranges::any_of(filters, [&](const auto& one) { return one.channel == q.channel; });
  };
  for (std::size_t i = problem.model.quantities.size(); i-- > 0;) {
    if (!is_replaced(problem.model.quantities[i])) continue;
    const auto at_i = static_cast<std::ptrdiff_t>(i);
    problem.model.quantities.erase(problem.model.quantities.begin() + at_i);
    problem.initial.erase(problem.initial.begin() + at_i);
    problem.bounds.erase(problem.bounds.begin() + at_i);
    point.coordinates.erase(point.coordinates.begin() + at_i);
  }
  std::vector<FreeQuantity> quantities;
  std::vector<double> begin;
  for (const FreeTerm& term : others) {
    quantities.push_back(term.quantity);
    begin.push_back(term.begin);
  }
  Extended from = extended(std::move(problem), std::move(point), quantities, begin);
  return settle_noise(std::move(from.problem), std::move(from.point));
}

}  // namespace

std::optional<NoiseIteration> with_motor_lag_for_filters(const NoiseIteration& settled) {
  const std::vector<FoundFilter> filters = filters_of(settled);
  if (has_motor_lag(settled.problem.model) || filters.size() < 2) return std::nullopt;
  const double lag_s = std::ranges::min(filters, {}, &FoundFilter::lag_s).lag_s;
  NoiseIteration fit = replaced(settled, filters, {{free_term(Kind::kMotorLag), lag_s}});
  if (!(akaike_of(fit) < akaike_of(settled))) return std::nullopt;
  return fit;
}

bool may_be_mean(const LogModel& model, double delay_s) {
  constexpr double kShare = 0.25;
  return delay_s > kShare * model.row_spacing_s;
}

std::optional<NoiseIteration> with_averaging_for_filters(const NoiseIteration& settled) {
  const LogModel& model = settled.problem.model;
  std::vector<FoundFilter> filters = filters_of(settled);
  std::erase_if(filters, [&](const FoundFilter& one) {
    return !is_often_counted(one.channel) || !may_be_mean(model, one.delay_s) ||
           has_kind(model.quantities, Kind::kAveraging, one.channel);
  });
  if (filters.empty()) return std::nullopt;
  std::vector<FreeTerm> averaging;
  for (const FoundFilter& one : filters) {
    averaging.push_back({free_term(Kind::kAveraging, one.channel), 2.0 * one.delay_s});
  }
  return replaced(settled, filters, averaging);
}

std::optional<NoiseIteration> with_delay_for_filter(const NoiseIteration& settled) {
  LowestAic lowest(settled);
  for (const FoundFilter& one : filters_of(settled)) {
    const FreeQuantity delay = free_term(Kind::kSensorDelay, one.channel);
    NoiseIteration from = settled;
    std::vector<FreeTerm> added;
    if (const auto i = place_of(settled.problem.model.quantities, delay.name())) {
      from.point.coordinates[*i] += one.delay_s;
    } else {
      added.push_back({delay, one.delay_s});
    }
    lowest.consider(replaced(from, {one}, added));
  }
  return std::move(lowest.best());
}

std::optional<NoiseIteration> with_motor_lag_and_delay(const NoiseIteration& settled) {
  constexpr double kShare = 0.5;  // initial guess of the motor lag, divided by the fitted delay
  const std::vector<FreeQuantity>& quantities = settled.problem.model.quantities;
  const auto delay = place_of(quantities, Kind::kDelay);
  if (!delay || has_motor_lag(settled.problem.model)) return {};
  const double lag_s = kShare * settled.point.coordinates[*delay];
  if (!(lag_s > 0.0)) return {};
  NoiseIteration from = settled;
  from.point.coordinates[*delay] -= lag_s;
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
