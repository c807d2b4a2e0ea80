#include "awmr/identify/logs/noise_iteration.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/logs/ceres_problem.h"
#include "awmr/identify/tables/robust.h"
#include "awmr/identify/uncertainty/quantiles.h"

namespace awmr {
namespace {

/// The raw residuals of one channel over all windows, and their sums over neighbours.
struct ChannelResiduals {
  std::vector<double> e;
  double products = 0.0;  ///< sum e_k e_{k-1}
  double squares = 0.0;   ///< sum (e_k^2 + e_{k-1}^2)/2
  double span_s = 0.0;    ///< sum of the times between
};

std::map<LogChannel, ChannelResiduals> by_channel(const std::vector<FitWindow>& windows,
                                                  const std::vector<WindowResiduals>& residuals) {
  std::map<LogChannel, ChannelResiduals> channels;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    std::map<LogChannel, std::optional<double>> previous;
    for (std::size_t i = 0; i < windows[w].samples.size(); ++i) {
      const Sample& sample = windows[w].samples[i];
      const double e = residuals[w].raw(eigen_index(i));
      ChannelResiduals& channel = channels[sample.channel];
      channel.e.push_back(e);
      std::optional<double>& before = previous[sample.channel];
      if (before) {
        channel.products += e * *before;
        channel.squares += 0.5 * (e * e + *before * *before);
        channel.span_s += sample.since_s;
      }
      before = e;
    }
  }
  return channels;
}

/// Standard deviation from n residuals of which `free_share` are free (by the median under a robust
/// loss), correlation from the first lag:
///
///     rho = sum e_k e_{k-1} / sum (e_k^2 + e_{k-1}^2)/2,   tau = -dt / ln rho
ChannelNoise with_levels(ChannelNoise noise, const ChannelResiduals& channel, double free_share,
                         Loss loss) {
  const Eigen::Map<const Eigen::VectorXd> e(channel.e.data(), rows_of(channel.e));
  const double n = static_cast<double>(channel.e.size());
  const double free = n * free_share;
  noise.std = loss == Loss::kSquared ? std::sqrt(e.squaredNorm() / free) : median_scale(e);
  noise.std = std::max(noise.std, kMinimumStd);
  const double rho = channel.squares > 0.0 ? channel.products / channel.squares : 0.0;
  // Correlation of no consequence (below a tenth) is left alone.
  const bool autocorrelated = rho * std::sqrt(n) > kNormalQuantile995 && rho > 0.1;
  noise.step_s = channel.span_s / n;
  noise.correlation_s =
      autocorrelated ? -(channel.span_s / n) / std::log(std::min(rho, 0.999)) : 0.0;
  return noise;
}

NoiseLevels noise_levels(const LogProblem& problem, const std::vector<WindowResiduals>& residuals,
                         Loss loss) {
  const auto channels = by_channel(problem.windows, residuals);
  double total = 0.0;
  for (const auto& [name, channel] : channels) total += static_cast<double>(channel.e.size());
  const double spent = static_cast<double>(problem.unknowns());
  const double free_share = std::max(0.1, 1.0 - spent / total);
  NoiseLevels levels;
  for (const auto& [name, noise] : problem.model.noise) {
    levels[name] = with_levels(noise, channels.at(name), free_share, loss);
  }
  return levels;
}

/// The largest change of a level or of a correlation time, relative.
double largest_change(const NoiseLevels& before, const NoiseLevels& after) {
  double change = 0.0;
  for (const auto& [channel, noise] : after) {
    const ChannelNoise& old = before.at(channel);
    change = std::max(change, std::abs(noise.std / old.std - 1.0));
    const double longer_s = std::max(noise.correlation_s, old.correlation_s);
    if (longer_s > 0.0) {
      change = std::max(change, std::abs(noise.correlation_s - old.correlation_s) / longer_s);
    }
  }
  return change;
}

/// The square root of a loss's weight at a standardised residual r. The constants keep 95 % of the
/// efficiency where the errors are normal:
///
///     Huber 1 for |r| <= 1.345, else 1.345/|r|;   Cauchy 1/(1 + (r/2.385)^2);
///     Tukey (1 - (r/4.685)^2)^2 for |r| < 4.685, else 0
double sqrt_weight(Loss loss, double r) {
  const double size = std::abs(r);
  switch (loss) {
    case Loss::kSquared:
      return 1.0;
    case Loss::kHuber:
      return size <= 1.345 ? 1.0 : std::sqrt(1.345 / size);
    case Loss::kCauchy:
      return 1.0 / std::sqrt(1.0 + r * r / (2.385 * 2.385));
    case Loss::kTukey:
      return size < 4.685 ? 1.0 - r * r / (4.685 * 4.685) : 0.0;
  }
  return 1.0;
}

void weigh(LogProblem& problem, const std::vector<WindowResiduals>& residuals, Loss loss) {
  if (loss == Loss::kSquared) return;
  for (std::size_t w = 0; w < problem.windows.size(); ++w) {
    for (std::size_t i = 0; i < problem.windows[w].samples.size(); ++i) {
      Sample& sample = problem.windows[w].samples[i];
      const double std = problem.model.noise.at(sample.channel).std;
      sample.weight = sqrt_weight(loss, residuals[w].raw(eigen_index(i)) / std);
    }
  }
}

}  // namespace

NoiseIteration settle_noise(LogProblem problem, SearchPoint point, Loss loss) {
  constexpr int kRounds = 6;
  constexpr double kSettled = 0.01;
  constexpr double kMiddling = 1e-6;
  const double fine_step_s = problem.model.longest_step_s;
  for (int round = 0; round < kRounds; ++round) {
    problem.model.longest_step_s = round == 0 ? kRoughStep * fine_step_s : fine_step_s;
    point = solve(problem, std::move(point), kMiddling).point;
    problem.model.longest_step_s = fine_step_s;
    const std::vector<WindowResiduals> residuals = evaluate_all(problem, point, false);
    if (!all_finite(residuals)) break;  // fit_logs() refuses
    const NoiseLevels levels = noise_levels(problem, residuals, loss);
    const double change = largest_change(problem.model.noise, levels);
    problem.model.noise = levels;
    weigh(problem, residuals, loss);
    if (change < kSettled && round > 0) break;
  }
  return {std::move(problem), std::move(point)};
}

}  // namespace awmr
