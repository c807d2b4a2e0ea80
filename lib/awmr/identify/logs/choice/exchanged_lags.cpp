#include "awmr/identify/logs/choice/exchanged_lags.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "awmr/identify/logs/choice/term_trials.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// The inertia of an axis (m' or I'z) in a fit, and the time constant of the motion.
struct AxisMotion {
  std::size_t inertia;     ///< index of the inertia among the quantities of the fit
  double time_constant_s;  ///< inertia divided by the slope of the resistance, > 0
};

/// Motion along an axis (kSpeed: surge; kYawRate), for small changes about half of the largest
/// measured speed or yaw rate. Empty if the fit does not estimate the inertia.
std::optional<AxisMotion> motion_of(const LogProblem& problem, const SearchPoint& point,
                                    LogChannel axis) {
  constexpr double kShare = 0.5;
  const LogModel& model = problem.model;
  const bool is_yaw = axis == LogChannel::kYawRate;
  const auto inertia =
      place_of(model.quantities, is_yaw ? ParameterId::kInertiaNorm : ParameterId::kMassNorm);
  if (!inertia) return std::nullopt;
  const Plant<double> plant =
      plant_of(model.vehicle, parameters_at(model.held, model.quantities, point.coordinates));
  const double lever = is_yaw ? plant.half_track_m * plant.half_track_m : 1.0;
  const double braking = model.vehicle.driven_wheels() * plant.back_emf_s_per_m * lever;
  const double rate = kShare * fastest_of(problem, axis);
  const double inertia_norm = is_yaw ? plant.inertia_norm : plant.mass_norm;
  const double time_constant_s =
      inertia_norm / (slope(is_yaw ? plant.yaw : plant.surge, rate) + braking);
  if (!(time_constant_s > 0.0) || !std::isfinite(time_constant_s)) return std::nullopt;
  return AxisMotion{*inertia, time_constant_s};
}

/// A lag of the fit, and the axes whose motion it precedes or follows.
struct Lag {
  std::size_t place;  ///< index among the quantities of the fit
  std::vector<LogChannel> axes;
};

std::vector<Lag> lags_of(const std::vector<FreeQuantity>& quantities) {
  std::vector<Lag> lags;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const FreeQuantity& q = quantities[i];
    if (q.is(Kind::kMotorLag)) lags.push_back({i, {LogChannel::kYawRate, LogChannel::kSpeed}});
    if (q.is(ParameterId::kSteeringTimeConstant)) lags.push_back({i, {LogChannel::kYawRate}});
    if (q.kind == Kind::kSensorLag &&
        (q.channel == LogChannel::kSpeed || q.channel == LogChannel::kYawRate)) {
      lags.push_back({i, {q.channel}});
    }
  }
  return lags;
}

/// Sets the value of quantity `i`, within its bounds.
void set_value(std::size_t i, double value, const LogProblem& problem, SearchPoint& point) {
  const auto& [lo, hi] = problem.bounds[i];
  point.coordinates[i] =
      std::clamp(to_coordinate(problem.model.quantities[i].scale, value), lo, hi);
}

/// The point `at` with the time constants of `lag` and of the motion along `axis` exchanged. A lag
/// of the motors acts on both axes: the motion along the other axis becomes slower by as much as
/// the lag becomes faster. Empty if the exchange changes little, or if the other axis would then
/// move at once.
std::optional<SearchPoint> exchanged(const LogProblem& problem, const SearchPoint& at,
                                     const Lag& lag, LogChannel axis) {
  constexpr double kNearlyEqual = 1.2;
  constexpr double kFastest = 0.2;
  const auto motion = motion_of(problem, at, axis);
  if (!motion) return std::nullopt;
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  const auto value = [&](std::size_t i) { return quantities[i].value(at.coordinates[i]); };
  const double lag_s = value(lag.place);
  const double ratio = motion->time_constant_s / lag_s;
  if (!(lag_s > 0.0) || !(std::max(ratio, 1.0 / ratio) > kNearlyEqual)) return std::nullopt;
  SearchPoint point = at;
  set_value(lag.place, motion->time_constant_s, problem, point);
  set_value(motion->inertia, value(motion->inertia) / ratio, problem, point);
  for (const LogChannel other : lag.axes) {
    const auto slower = other == axis ? std::nullopt : motion_of(problem, at, other);
    if (!slower) continue;
    const double by = 1.0 + (lag_s - motion->time_constant_s) / slower->time_constant_s;
    if (by < kFastest) return std::nullopt;
    set_value(slower->inertia, by * value(slower->inertia), problem, point);
  }
  return point;
}

/// A start of a search, with the lag that was exchanged.
struct ExchangedStart {
  std::size_t lag;
  SearchPoint point;
};

std::vector<ExchangedStart> exchanged_starts(const LogProblem& problem, const SearchPoint& at) {
  std::vector<ExchangedStart> starts;
  for (const Lag& lag : lags_of(problem.model.quantities)) {
    for (const LogChannel axis : lag.axes) {
      if (auto point = exchanged(problem, at, lag, axis)) {
        starts.push_back({lag.place, *std::move(point)});
      }
    }
  }
  return starts;
}

}  // namespace

std::optional<NoiseIteration> with_exchanged_lag(const NoiseIteration& settled) {
  constexpr double kOtherOptimum = 1.0;  // decrease of AIC that is not due to the end of a search
  const std::vector<ExchangedStart> starts = exchanged_starts(settled.problem, settled.point);
  if (starts.empty()) return std::nullopt;
  LowestAic lowest(tried(settled, {}));
  for (const ExchangedStart& start : starts) {
    lowest.consider(tried({.problem = settled.problem, .point = start.point}, {}), kOtherOptimum);
  }
  if (!lowest.best()) return std::nullopt;
  NoiseIteration fit =
      settle_noise(std::move(lowest.best()->problem), std::move(lowest.best()->point));
  if (!(akaike_of(settled) - akaike_of(fit) > kOtherOptimum)) return std::nullopt;
  return fit;
}

std::optional<ExchangedOptimum> equally_likely_exchange(const LogProblem& problem,
                                                        const SearchPoint& optimum) {
  constexpr double kUndecided = 6.0;
  constexpr double kTolerance = 1e-6;
  constexpr double kOther = 1.1;  // ratio of two lags that are not the same optimum
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  const std::vector<ExchangedStart> starts = exchanged_starts(problem, optimum);
  if (starts.empty()) return std::nullopt;
  const double cost = solve(problem, optimum, kTolerance).cost;
  std::optional<ExchangedOptimum> likeliest;
  for (const ExchangedStart& start : starts) {
    const Solved other = solve(problem, start.point, kTolerance);
    if (!other.usable) continue;
    const double excess = 2.0 * (other.cost - cost);
    const double ratio = quantities[start.lag].value(other.point.coordinates[start.lag]) /
                         quantities[start.lag].value(optimum.coordinates[start.lag]);
    const bool is_other = !(ratio > 1.0 / kOther && ratio < kOther);
    const double most = likeliest ? likeliest->aic_excess : kUndecided;
    if (is_other && excess < most) {
      likeliest = ExchangedOptimum{start.lag, other.point.coordinates, excess};
    }
  }
  return likeliest;
}

}  // namespace awmr
