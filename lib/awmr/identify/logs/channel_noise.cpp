#include "awmr/identify/logs/channel_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "awmr/core/index.h"

namespace awmr {
namespace {

/// Second differences of one channel.
struct Roughness {
  double squares = 0.0;
  int count = 0;
};

void add_second_differences(const std::vector<double>& values, Roughness& roughness) {
  for (std::size_t k = 2; k < values.size(); ++k) {
    const double d = values[k] - 2.0 * values[k - 1] + values[k - 2];
    roughness.squares += d * d;
    ++roughness.count;
  }
}

}  // namespace

NoiseLevels sensor_noise(const std::vector<FitWindow>& windows) {
  NoiseLevels levels;
  std::map<LogChannel, Roughness> roughness;
  for (const FitWindow& window : windows) {
    std::map<LogChannel, std::vector<double>> values;
    for (const Sample& sample : window.samples) {
      values[sample.channel].push_back((*window.rows.log)[sample.channel]->value[sample.row]);
      ++levels[sample.channel].count;
    }
    for (const auto& [channel, series] : values) {
      add_second_differences(series, roughness[channel]);
    }
  }
  for (auto& [channel, noise] : levels) {
    const auto& [squares, count] = roughness[channel];
    noise.std = std::max(count > 0 ? std::sqrt(squares / (6.0 * count)) : 1.0, kMinimumStd);
    noise.sensor_std = noise.std;
  }
  return levels;
}

}  // namespace awmr
