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
    return q.kind == FreeQuantity::Kind::kSensorDelay && q.channel == channel;
  });
}

bool is_of_commands(const FreeQuantity& q) {
  return q.kind == FreeQuantity::Kind::kDelay || q.kind == FreeQuantity::Kind::kMotorLag;
}

/// A delay of the commands and of every measured channel, one for both coordinates of the position,
/// where they have none yet; none where all but one have.
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
  return found;
}

/// A delay worth a try, with where one step would put it.
struct Suspect {
  FreeQuantity delay;
  double value_s;
  double significance;  ///< |value| over standard error, by the noise alone
};

/// The likeliest first.
std::vector<Suspect> suspects(const NoiseIteration& settled) {
  constexpr double kWorthATry = 3.0;
  const std::vector<FreeQuantity> channels = candidates(settled.problem);
  const std::vector<ScoreTest> tests = score_test(settled.problem, settled.point, channels);
  std::vector<Suspect> found;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const double value_s = tests[i].value;
    if (channels[i].may_be_zero() && !(value_s > 0.0)) continue;
    const double significance = std::abs(value_s) / tests[i].noise_error;
    if (significance > kWorthATry) found.push_back({channels[i], value_s, significance});
  }
  std::ranges::stable_sort(found, std::greater{}, &Suspect::significance);
  return found;
}

double akaike_of(const NoiseIteration& fit) {
  return akaike(fit.problem.model.noise, rows_of(fit.problem.model.quantities));
}

/// The fit with one more quantity free, searched from `begin_s`.
NoiseIteration with(const NoiseIteration& settled, const FreeQuantity& more, double begin_s,
                    Loss loss) {
  constexpr double kLongestFirstStep_s = 0.3;
  begin_s = std::clamp(begin_s, -kLongestFirstStep_s, kLongestFirstStep_s);
  Extended from = extended(with_white_noise(settled.problem), settled.point, {more}, {begin_s});
  return settle_noise(std::move(from.problem), std::move(from.point), loss);
}

/// The fit with a suspect's delay free, if that lowers AIC enough.
std::optional<NoiseIteration> with_delay(const NoiseIteration& settled, const Suspect& suspect,
                                         Loss loss) {
  constexpr double kPlainly = 10.0;  // of AIC
  NoiseIteration late = with(settled, suspect.delay, suspect.value_s, loss);
  if (!(akaike_of(settled) - akaike_of(late) > kPlainly)) return std::nullopt;
  const double found_s = late.point.coordinates.back();
  if (suspect.delay.kind != FreeQuantity::Kind::kDelay || !(found_s > 0.0)) return late;
  NoiseIteration lagging = with(settled, motor_lag(), found_s, loss);
  return akaike_of(lagging) < akaike_of(late) ? std::move(lagging) : std::move(late);
}

/// The fit with one more delay free, that of the commands or of one sensor, whichever has the lower AIC;
/// none where neither lowers it enough.
std::optional<NoiseIteration> with_one_more(const NoiseIteration& settled, Loss loss) {
  std::optional<NoiseIteration> commands;
  std::optional<NoiseIteration> sensor;
  for (const Suspect& suspect : suspects(settled)) {
    std::optional<NoiseIteration>& place = is_of_commands(suspect.delay) ? commands : sensor;
    if (!place) place = with_delay(settled, suspect, loss);
  }
  if (!commands || !sensor) return commands ? std::move(commands) : std::move(sensor);
  return akaike_of(*commands) <= akaike_of(*sensor) ? std::move(commands) : std::move(sensor);
}

}  // namespace

NoiseIteration allow_for_delays(NoiseIteration settled, Loss loss) {
  while (auto more = with_one_more(settled, loss))
    settled = std::move(*more);  // ends: all have one
  return settled;
}

}  // namespace awmr
