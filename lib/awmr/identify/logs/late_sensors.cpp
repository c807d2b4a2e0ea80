#include "awmr/identify/logs/late_sensors.h"

#include <algorithm>
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

/// A delay for every measured channel that has none yet; one for both coordinates of the position.
std::vector<FreeQuantity> candidates(const LogProblem& problem) {
  std::vector<FreeQuantity> found;
  for (const auto& [measured, noise] : problem.model.noise) {
    const LogChannel channel = measured == LogChannel::kY ? LogChannel::kX : measured;
    if (has_delay(problem.model.quantities, channel) || has_delay(found, channel)) continue;
    found.push_back(sensor_delay_of(channel));
  }
  return found;
}

/// A channel that may be late, with where one step would put its delay.
struct Suspect {
  FreeQuantity delay;
  double value_s;
  double significance;  ///< value over standard error
};

/// The channels worth a try, the likeliest first.
std::vector<Suspect> suspects(const NoiseIteration& settled) {
  constexpr double kWorthATry = 1.5;  // standard errors, which the delay's own misfit widens
  const std::vector<FreeQuantity> channels = candidates(settled.problem);
  const std::vector<ScoreTest> tests = score_test(settled.problem, settled.point, channels);
  std::vector<Suspect> found;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (!(tests[i].value > kWorthATry * tests[i].std_error)) continue;
    found.push_back({channels[i], tests[i].value, tests[i].value / tests[i].std_error});
  }
  std::ranges::sort(found, std::greater{}, &Suspect::significance);
  return found;
}

/// The fit with a suspect's delay free, if it is plainly likelier for it.
std::optional<NoiseIteration> with_delay(const NoiseIteration& settled, const Suspect& suspect,
                                         Loss loss) {
  constexpr double kPlainly = 10.0;  // of AIC
  constexpr double kLongestFirstStep_s = 0.3;
  Extended with = extended(with_white_noise(settled.problem), settled.point, {suspect.delay},
                           {std::min(suspect.value_s, kLongestFirstStep_s)});
  NoiseIteration trial = settle_noise(std::move(with.problem), std::move(with.point), loss);
  const Eigen::Index n = rows_of(settled.problem.model.quantities);
  const double gain =
      akaike(settled.problem.model.noise, n) - akaike(trial.problem.model.noise, n + 1);
  if (!(gain > kPlainly)) return std::nullopt;
  return trial;
}

}  // namespace

NoiseIteration allow_for_late_sensors(NoiseIteration settled, Loss loss) {
  const bool input_delay = std::ranges::any_of(
      settled.problem.model.quantities,
      [](const FreeQuantity& q) { return q.kind == FreeQuantity::Kind::kDelay; });
  for (bool found = !input_delay; found;) {  // ends: every round frees another channel
    found = false;
    for (const Suspect& suspect : suspects(settled)) {
      std::optional<NoiseIteration> trial = with_delay(settled, suspect, loss);
      if (!trial) continue;
      settled = std::move(*trial);
      found = true;
      break;
    }
  }
  return settled;
}

}  // namespace awmr
