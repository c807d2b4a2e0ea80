#include "awmr/identify/logs/delays.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/logs/information.h"
#include "awmr/identify/logs/score_test.h"

namespace awmr {
namespace {

bool has_delay(const std::vector<FreeQuantity>& quantities, LogChannel channel) {
  return std::ranges::any_of(quantities, [&](const FreeQuantity& q) {
    const bool is_of_sensor =
        q.kind == FreeQuantity::Kind::kSensorDelay || q.kind == FreeQuantity::Kind::kSensorLag;
    return is_of_sensor && q.channel == channel;
  });
}

bool is_of_steering(const FreeQuantity& q) { return q.kind == FreeQuantity::Kind::kSteeringDelay; }

bool is_of_commands(const FreeQuantity& q) {
  return q.kind == FreeQuantity::Kind::kDelay || q.kind == FreeQuantity::Kind::kMotorLag;
}

/// Whether the lag of the servo is free, so that a dead time of the steering could pass for it.
bool frees_servo(const std::vector<FreeQuantity>& quantities) {
  return std::ranges::any_of(
      quantities, [](const FreeQuantity& q) { return q.is(ParameterId::kSteeringTimeConstant); });
}

/// A delay of the commands and of every measured channel, one for both coordinates of the position,
/// where they have none yet; none where all but one have. And one of the steering alone.
std::vector<FreeQuantity> candidates(const LogProblem& problem) {
  const std::vector<FreeQuantity>& quantities = problem.model.quantities;
  std::vector<FreeQuantity> found;
  if (std::ranges::none_of(quantities, is_of_commands)) found.push_back(input_delay());
  for (const auto& [measured, noise] : problem.model.noise) {
    const LogChannel channel = measured == LogChannel::kY ? LogChannel::kX : measured;
    if (has_delay(quantities, channel) || has_delay(found, channel)) continue;
    found.push_back(sensor_delay_of(channel));
  }
  if (found.size() == 1) found.clear();
  if (frees_servo(quantities) && std::ranges::none_of(quantities, is_of_steering)) {
    found.push_back(steering_delay());
  }
  return found;
}

/// A delay worth a try, with where one step would put it.
struct CandidateTerm {
  FreeQuantity delay;
  double value_s;
  double significance;  ///< |value| over standard error, by the noise alone
};

/// The likeliest first.
std::vector<CandidateTerm> candidate_terms(const NoiseIteration& settled) {
  constexpr double kWorthATry = 3.0;
  const std::vector<FreeQuantity> channels = candidates(settled.problem);
  const std::vector<ScoreTest> tests = score_test(settled.problem, settled.point, channels);
  std::vector<CandidateTerm> found;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const double value_s = tests[i].value;
    if (channels[i].may_be_zero() && !(value_s > 0.0)) continue;
    const double significance = std::abs(value_s) / tests[i].noise_error;
    if (significance > kWorthATry) found.push_back({channels[i], value_s, significance});
  }
  std::ranges::stable_sort(found, std::greater{}, &CandidateTerm::significance);
  return found;
}

double akaike_of(const NoiseIteration& fit) {
  return akaike(fit.problem.model.noise, rows_of(fit.problem.model.quantities));
}

/// One round of the fit with one more quantity free, from `begin_s`.
NoiseIteration tried(const NoiseIteration& settled, const FreeQuantity& more, double begin_s,
                     Loss loss) {
  constexpr double kLongestFirstStep_s = 0.3;
  begin_s = std::clamp(begin_s, -kLongestFirstStep_s, kLongestFirstStep_s);
  Extended from = extended(with_white_noise(settled.problem), settled.point, {more}, {begin_s});
  return settle_noise(std::move(from.problem), std::move(from.point), loss, 1);
}

/// Readings that a program may smooth before it logs them.
bool may_be_smoothed(LogChannel channel) {
  return channel == LogChannel::kSpeed || channel == LogChannel::kYawRate;
}

/// The likeliest fit with one more delay or lag free, of the commands, of the steering alone or of
/// one sensor, after one round; none if no candidate term improves the fit.
std::optional<NoiseIteration> likeliest_with_one_more(const NoiseIteration& settled, Loss loss) {
  // A filter of the speed looks like a lag of the motors, which more vehicles have, where no other
  // channel separates them; both give the same mass then. Else it has to be likelier by this much
  // of AIC.
  constexpr double kLikelierFilter = 10.0;
  const bool tells_filters = settled.problem.model.noise.size() > 1;
  std::optional<NoiseIteration> best;
  double least = akaike_of(settled);
  const auto consider = [&](NoiseIteration fit, double by = 0.0) {
    const double criterion = akaike_of(fit);
    if (!(criterion + by < least)) return false;
    least = criterion;
    best = std::move(fit);
    return true;
  };
  const bool is_lag_given = settled.problem.model.vehicle.motor_time_constant_s.has_value();
  bool has_sensor = false;
  std::vector<std::pair<LogChannel, double>> filters;
  for (const CandidateTerm& candidate_term : candidate_terms(settled)) {
    const FreeQuantity& delay = candidate_term.delay;
    const bool is_sensor = delay.kind == FreeQuantity::Kind::kSensorDelay;
    if (is_sensor && has_sensor) continue;
    NoiseIteration delayed_fit = tried(settled, delay, candidate_term.value_s, loss);
    const double found_s = delayed_fit.point.coordinates.back();
    has_sensor |= consider(std::move(delayed_fit)) && is_sensor;
    if (!(found_s > 0.0)) continue;
    // Also where a sensor's delay does as well as one of the commands: a lag may do better than both.
    if (is_of_commands(delay) && !is_lag_given)
      consider(tried(settled, motor_lag(), found_s, loss));
    if (is_sensor && tells_filters && may_be_smoothed(delay.channel)) {
      filters.emplace_back(delay.channel, found_s);
    }
  }
  for (const auto& [channel, found_s] : filters) {
    consider(tried(settled, sensor_lag_of(channel), found_s, loss), kLikelierFilter);
  }
  return best;
}

/// The fit with one more delay free, where that lowers AIC enough.
std::optional<NoiseIteration> with_one_more(const NoiseIteration& settled, Loss loss) {
  constexpr double kPlainly = 10.0;  // of AIC
  std::optional<NoiseIteration> more = likeliest_with_one_more(settled, loss);
  if (!more) return std::nullopt;
  *more = settle_noise(std::move(more->problem), std::move(more->point), loss);
  if (!(akaike_of(settled) - akaike_of(*more) > kPlainly)) return std::nullopt;
  return more;
}

}  // namespace

NoiseIteration allow_for_delays(NoiseIteration settled, Loss loss) {
  while (auto more = with_one_more(settled, loss))
    settled = std::move(*more);  // ends: all have one
  return settled;
}

}  // namespace awmr
