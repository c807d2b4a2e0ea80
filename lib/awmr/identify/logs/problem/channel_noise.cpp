#include "awmr/identify/logs/problem/channel_noise.h"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/identify/logs/problem/whitener.h"

namespace awmr {
namespace {

/// Sum of squares and number of the second differences of one channel's readings.
struct Roughness {
  double squares = 0.0;
  int count = 0;
  int readings = 0;

  double std() const {
    return std::max(count > 0 ? std::sqrt(squares / (6.0 * count)) : 1.0, kMinimumStd);
  }
};

/// Roughness of each channel in each log (DrivingLog::number).
using RoughnessByLog = std::map<LogChannel, std::map<int, Roughness>>;

void add_second_differences(const std::vector<double>& values, Roughness& roughness) {
  for (std::size_t k = 2; k < values.size(); ++k) {
    const double d = values[k] - 2.0 * values[k - 1] + values[k - 2];
    roughness.squares += d * d;
    ++roughness.count;
  }
  roughness.readings += static_cast<int>(values.size());
}

RoughnessByLog roughness_of(const std::vector<FitWindow>& windows) {
  RoughnessByLog roughness;
  for (const FitWindow& window : windows) {
    const DrivingLog& log = *window.rows.log;
    std::map<LogChannel, std::vector<double>> values;
    for (const Sample& sample : window.samples()) {
      values[sample.channel].push_back(log[sample.channel]->value[sample.row]);
    }
    for (const auto& [channel, series] : values) {
      add_second_differences(series, roughness[channel][log.number]);
    }
  }
  return roughness;
}

/// True if the noise of a channel differs between logs, see sensor_noise(). The standard error of
/// ln sigma is 1/sqrt(n) for white noise, because neighbouring differences are correlated.
bool differs_between(const std::map<int, Roughness>& by_log) {
  constexpr int kFewest = 30;
  constexpr double kSmallestRatio = 1.3;
  constexpr double kErrors = 4.0;
  bool differs = false;
  for (const auto& [log, one] : by_log) {
    if (one.count < kFewest) return false;
    for (const auto& [other_log, other] : by_log) {
      const double difference = std::log(one.std() / other.std());
      const double error = std::sqrt(1.0 / one.count + 1.0 / other.count);
      differs |= difference > std::max(std::log(kSmallestRatio), kErrors * error);
    }
  }
  return differs;
}

/// Noise levels with the sensors of `levels`, as far as they occur.
NoiseLevels levels_of(const RoughnessByLog& roughness, const NoiseLevels& levels) {
  std::map<LogSensor, Roughness> sums;
  for (const auto& [channel, by_log] : roughness) {
    for (const auto& [log, one] : by_log) {
      Roughness& sum = sums[sensor_in(levels, channel, log).first];
      sum.squares += one.squares;
      sum.count += one.count;
      sum.readings += one.readings;
    }
  }
  NoiseLevels found;
  for (const auto& [sensor, sum] : sums) {
    found[sensor] = {.white_std = sum.std(), .sensor_std = sum.std(), .count = sum.readings};
  }
  return found;
}

/// Sums over the innovations nu_k with the variances S_k: sum nu_k^2/S_k, sum ln S_k, and their
/// number.
struct InnovationSums {
  double squares = 0.0;
  double log_variances = 0.0;
  double n = 0.0;
};

/// `most`: values of nu_k^2/S_k above `most` count as `most`.
InnovationSums innovation_sums(std::span<const ErrorSeries> series, const ChannelNoise& noise,
                               double most = kNoLimit) {
  InnovationSums sums;
  double product = 1.0;  // product of many S_k: one logarithm of the product replaces many
  for (const ErrorSeries& part : series) {
    Whitener whitener(noise);
    for (std::size_t k = 0; k < part.error.size(); ++k) {
      const auto [nu, variance] = whitener.next(part.error[k], part.since_s[k]);
      sums.squares += std::min(nu * nu / variance, most);
      product *= variance;
      if (product > 1e150 || product < 1e-150) {
        sums.log_variances += std::log(product);
        product = 1.0;
      }
    }
    sums.n += static_cast<double>(part.error.size());
  }
  sums.log_variances += std::log(product);
  return sums;
}

/// -2 ln L of n errors under a noise model, minimised over a common factor f on sigma_w^2 and
/// sigma_d^2. With the innovations nu_k and their variances S_k at f = 1:
///
///     -2 ln L = n ln f + sum ln S_k + constant,   f = (1/n) sum nu_k^2 / S_k
struct Likelihood {
  double cost = 0.0;    ///< -2 ln L with the best factor, up to a constant
  double factor = 1.0;  ///< the best factor on sigma_w^2 and sigma_d^2
};

Likelihood likelihood(std::span<const ErrorSeries> series, const ChannelNoise& noise) {
  const auto [squares, log_variances, n] = innovation_sums(series, noise);
  const double factor = std::max(squares / n, kMinimumStd * kMinimumStd);
  return {n * std::log(factor) + log_variances, factor};
}

/// Noise model with a total variance of 1. The drift has the share e^x/(1 + e^x) of this variance,
/// with x = `logit`; white noise has the rest.
ChannelNoise unit_noise(double logit, double correlation_s) {
  const double share = 1.0 / (1.0 + std::exp(-logit));
  return {.white_std = std::sqrt(1.0 - share),
          .drift_std = std::sqrt(share),
          .correlation_s = correlation_s};
}

/// Selects 20 000 to 30 000 errors, in whole windows spread over the logs, from which the drift of
/// a channel is estimated. This saves time, and 20 000 errors determine the standard deviations to
/// 1 %. Returns all errors if there are fewer than 40 000.
std::vector<ErrorSeries> some_of(std::span<const ErrorSeries> series) {
  constexpr std::size_t kEnough = 20'000;
  std::size_t total = 0;
  for (const ErrorSeries& part : series) total += part.error.size();
  const std::size_t every = std::max<std::size_t>(1, total / kEnough);
  std::vector<ErrorSeries> some;
  for (std::size_t i = 0; i < series.size(); i += every) some.push_back(series[i]);
  return some;
}

double median_step_s(std::span<const ErrorSeries> series) {
  std::vector<double> steps;
  for (const ErrorSeries& part : series) {
    for (const double s : part.since_s) {
      if (s > 0.0) steps.push_back(s);
    }
  }
  return steps.empty() ? 0.0 : median(std::move(steps));
}

struct NoiseCandidate {
  ChannelNoise noise;  ///< scaled to a total variance of 1
  double cost = std::numeric_limits<double>::infinity();

  bool is_significantly_better_than(double other) const {
    // Smallest decrease of -2 ln L that justifies two more parameters (p = 0.007).
    constexpr double kPlainly = 10.0;
    return cost < other - kPlainly;
  }
};

/// Returns the noise model with a first-order drift of the given correlation time. The drift's
/// share of the variance is the one that makes these errors most likely.
NoiseCandidate likeliest_share(std::span<const ErrorSeries> series, double correlation_s) {
  constexpr int kBits = 10;
  std::uintmax_t evaluations = 24;
  const auto cost = [&](double logit) {
    return likelihood(series, unit_noise(logit, correlation_s)).cost;
  };
  const auto [logit, least] =
      boost::math::tools::brent_find_minima(cost, -6.0, 9.0, kBits, evaluations);
  return {unit_noise(logit, correlation_s), least};
}

/// Returns the most likely first-order drift. The search evaluates a coarse grid of correlation
/// times, from half the sample interval to the length of a window, then refines the best one. It
/// skips the refinement if the best drift of the grid is hardly better than no drift. `white_cost`:
/// cost without a drift.
NoiseCandidate likeliest_drift(std::span<const ErrorSeries> series, double step_s,
                               double white_cost) {
  // The best drift of the grid is refined only if it lowers -2 ln L by more than this.
  constexpr double kWorthASearch = 4.0;
  constexpr int kGrid = 7;
  constexpr int kBits = 8;
  const double shortest = std::log(0.5 * step_s);
  const double longest = std::log(std::max(kWindow_s, 2.0 * step_s));
  const double spacing = (longest - shortest) / (kGrid - 1);
  NoiseCandidate best;
  double best_log = shortest;
  for (int i = 0; i < kGrid; ++i) {
    const double log_s = shortest + i * spacing;
    NoiseCandidate drift = likeliest_share(series, std::exp(log_s));
    if (!(drift.cost < best.cost)) continue;
    best = drift;
    best_log = log_s;
  }
  if (!(best.cost < white_cost - kWorthASearch)) return best;
  std::uintmax_t evaluations = 12;
  const double refined =
      boost::math::tools::brent_find_minima(
          [&](double log_s) { return likeliest_share(series, std::exp(log_s)).cost; },
          std::max(shortest, best_log - spacing), std::min(longest, best_log + spacing), kBits,
          evaluations)
          .first;
  NoiseCandidate drift = likeliest_share(series, std::exp(refined));
  return drift.cost < best.cost ? drift : best;
}

/// Search coordinates of a second-order drift: its share of the variance, frequency and damping.
struct SecondOrder {
  double logit = 0.0;
  double log_radps = 0.0;
  double log_damping = 0.0;

  std::array<double, 3> as_array() const { return {logit, log_radps, log_damping}; }
  ChannelNoise noise() const {
    ChannelNoise unit = unit_noise(logit, 0.0);
    unit.frequency_radps = std::exp(log_radps);
    unit.damping = std::exp(log_damping);
    // Decay time of the drift. For zeta > 1, the drift is a sum of two exponentials, and the slower
    // one counts.
    const double over = std::sqrt(std::max(0.0, unit.damping * unit.damping - 1.0));
    unit.correlation_s = 1.0 / (unit.frequency_radps * (unit.damping - over));
    return unit;
  }
};

/// Bounds of the search for a second-order drift. Share of the variance: 0.25 % to nearly all.
/// Period of oscillation: two sample intervals to two windows. Damping: 0.02 to 20.
struct SecondOrderRange {
  SecondOrder lowest;
  SecondOrder highest;

  explicit SecondOrderRange(double step_s)
      : lowest{-6.0, std::log(std::numbers::pi / kWindow_s), std::log(0.02)},
        highest{18.0, std::log(std::max(std::numbers::pi / step_s, std::numbers::pi)),
                std::log(20.0)} {}
};

NoiseCandidate as_drift(std::span<const ErrorSeries> series, const SecondOrder& s) {
  const ChannelNoise noise = s.noise();
  return {noise, likelihood(series, noise).cost};
}

/// Returns the most likely point of a coarse grid of frequencies and of shares of the variance.
SecondOrder likeliest_of_grid(std::span<const ErrorSeries> series, const SecondOrderRange& range) {
  constexpr int kFrequencies = 8;
  SecondOrder best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kFrequencies; ++i) {
    const double part = (i + 0.5) / kFrequencies;
    const double log_radps = std::lerp(range.lowest.log_radps, range.highest.log_radps, part);
    for (const double logit : {0.0, 4.0, 10.0}) {
      const SecondOrder s{logit, log_radps, std::log(0.7)};
      const double cost = as_drift(series, s).cost;
      if (!(cost < least)) continue;
      least = cost;
      best = s;
    }
  }
  return best;
}

/// Data of the NLopt callback, and the best point so far.
struct SecondOrderSearch {
  std::span<const ErrorSeries> series;
  NoiseCandidate best = {};
};

double second_order_cost(unsigned, const double* x, double*, void* data) {
  auto& search = *static_cast<SecondOrderSearch*>(data);
  const NoiseCandidate drift = as_drift(search.series, {x[0], x[1], x[2]});
  if (!std::isfinite(drift.cost)) return std::numeric_limits<double>::max();
  if (drift.cost < search.best.cost) search.best = drift;
  return drift.cost;
}

/// Nelder-Mead search from the point `from` [NLopt, LN_NELDERMEAD]. Returns the best point so far
/// even if the search fails, because the caller compares this point with the other noise models.
NoiseCandidate likeliest_from(std::span<const ErrorSeries> series, const SecondOrder& from,
                              const SecondOrderRange& range) {
  constexpr int kMaxEvaluations = 150;
  constexpr double kFine = 0.02;  // the search ends when -2 ln L changes by less than this
  constexpr double kFirstStep = 0.5;
  const std::array<double, 3> lowest = range.lowest.as_array();
  const std::array<double, 3> highest = range.highest.as_array();
  std::array<double, 3> x = from.as_array();
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::clamp(x[i], lowest[i], highest[i]);
  SecondOrderSearch search{series};
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> opt(
      nlopt_create(NLOPT_LN_NELDERMEAD, 3), &nlopt_destroy);
  nlopt_set_lower_bounds(opt.get(), lowest.data());
  nlopt_set_upper_bounds(opt.get(), highest.data());
  nlopt_set_min_objective(opt.get(), second_order_cost, &search);
  nlopt_set_initial_step1(opt.get(), kFirstStep);
  nlopt_set_ftol_abs(opt.get(), kFine);
  nlopt_set_maxeval(opt.get(), kMaxEvaluations);
  double least = 0.0;
  nlopt_optimize(opt.get(), x.data(), &least);
  return search.best;
}

/// Returns the most likely second-order drift. The search starts at the drift of `before` if that
/// is of second order, else at the best point of a coarse grid.
NoiseCandidate likeliest_second_order(std::span<const ErrorSeries> series, double step_s,
                                      const ChannelNoise& before) {
  const SecondOrderRange range(step_s);
  if (!before.second_order())
    return likeliest_from(series, likeliest_of_grid(series, range), range);
  const double share = std::pow(before.drift_std / before.std(), 2);
  const double logit = std::log(share / std::max(1.0 - share, 1e-9));
  return likeliest_from(series, {logit, std::log(before.frequency_radps), std::log(before.damping)},
                        range);
}

NoiseCandidate likeliest_difference(std::span<const ErrorSeries> series) {
  constexpr int kBits = 10;
  constexpr double kMaxTheta = 0.9999;
  std::uintmax_t evaluations = 24;
  const auto noise = [](double theta) {
    return ChannelNoise{.white_std = 1.0 / std::hypot(1.0, theta), .differenced = theta};
  };
  const auto cost = [&](double theta) { return likelihood(series, noise(theta)).cost; };
  const auto [theta, least] =
      boost::math::tools::brent_find_minima(cost, 0.0, kMaxTheta, kBits, evaluations);
  return {noise(theta), least};
}

}  // namespace

std::string describe(const LogSensor& sensor) {
  const std::string_view name = info(sensor.channel).name;
  return sensor.log != 0 ? fmt::format("{} in log {}", name, sensor.log) : std::string(name);
}

std::set<LogChannel> channels_of(const NoiseLevels& levels) {
  std::set<LogChannel> channels;
  for (const auto& [sensor, noise] : levels) channels.insert(sensor.channel);
  return channels;
}

bool has_channel(const NoiseLevels& levels, LogChannel channel) {
  const auto first = levels.lower_bound({channel});
  return first != levels.end() && first->first.channel == channel;
}

bool any_sensor(const NoiseLevels& levels, LogChannel channel, bool (ChannelNoise::*test)() const) {
  return std::ranges::any_of(levels, [&](const auto& level) {
    return level.first.channel == channel && (level.second.*test)();
  });
}

const NoiseLevels::value_type& sensor_in(const NoiseLevels& levels, LogChannel channel, int log) {
  const auto own = levels.find({channel, log});
  return own != levels.end() ? *own : *levels.lower_bound({channel});
}

NoiseLevels sensor_noise(const std::vector<FitWindow>& windows) {
  const RoughnessByLog roughness = roughness_of(windows);
  NoiseLevels levels;
  for (const auto& [channel, by_log] : roughness) {
    const bool differs = differs_between(by_log);
    for (const auto& [log, one] : by_log) levels[{channel, differs ? log : 0}];
  }
  return levels_of(roughness, levels);
}

NoiseLevels sensor_noise(const std::vector<FitWindow>& windows, const NoiseLevels& levels) {
  return levels_of(roughness_of(windows), levels);
}

double cost_of(std::span<const ErrorSeries> series, const ChannelNoise& noise, double most) {
  const InnovationSums sums = innovation_sums(series, noise, most);
  return sums.squares + sums.log_variances;
}

ChannelNoise likeliest_noise(std::span<const ErrorSeries> series, double free_share,
                             const ChannelNoise& before) {
  ChannelNoise noise{.white_std = 1.0};
  const std::vector<ErrorSeries> some = some_of(series);
  const double step_s = median_step_s(some);
  if (step_s > 0.0) {
    double cost = likelihood(some, noise).cost;
    const auto take_if_better = [&](const NoiseCandidate& other) {
      if (!other.is_significantly_better_than(cost)) return false;
      noise = other.noise;
      cost = other.cost;
      return true;
    };
    if (take_if_better(likeliest_drift(some, step_s, cost))) {
      take_if_better(likeliest_second_order(some, step_s, before));
    }
    take_if_better(likeliest_difference(some));
  }
  const Likelihood scale = likelihood(series, noise);
  const double std = std::max(std::sqrt(scale.factor / free_share), kMinimumStd);
  noise.white_std *= std;
  noise.drift_std *= std;
  noise.sensor_std = before.sensor_std;
  for (const ErrorSeries& part : series) noise.count += static_cast<int>(part.error.size());
  noise.cost = scale.cost;
  return noise;
}

}  // namespace awmr
