#include "awmr/identify/logs/late_sensors.h"

#include <algorithm>
#include <utility>

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

}  // namespace

NoiseIteration allow_for_late_sensors(NoiseIteration settled, Loss loss) {
  constexpr double kPlainly = 4.0;
  constexpr double kLongestFirstStep_s = 0.3;
  constexpr int kRounds = 3;
  const bool input_delay = std::ranges::any_of(
      settled.problem.model.quantities,
      [](const FreeQuantity& q) { return q.kind == FreeQuantity::Kind::kDelay; });
  for (int round = 0; round < kRounds && !input_delay; ++round) {
    const std::vector<FreeQuantity> channels = candidates(settled.problem);
    const std::vector<ScoreTest> tests = score_test(settled.problem, settled.point, channels);
    std::vector<FreeQuantity> late;
    std::vector<double> delay_s;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (!(tests[i].value > kPlainly * tests[i].std_error)) continue;
      late.push_back(channels[i]);
      delay_s.push_back(std::min(tests[i].value, kLongestFirstStep_s));
    }
    if (late.empty()) break;
    Extended with = extended(std::move(settled.problem), std::move(settled.point), late, delay_s);
    settled = settle_noise(std::move(with.problem), std::move(with.point), loss);
  }
  return settled;
}

}  // namespace awmr
