#include "awmr/identify/logs/problem/noise_iteration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/index.h"
#include "awmr/core/parallel.h"
#include "awmr/identify/tables/robust.h"

namespace awmr {
namespace {

ErrorsBySensor by_sensor(const LogProblem& problem, const std::vector<WindowErrors>& errors) {
  const std::vector<FitWindow>& windows = problem.windows;
  ErrorsBySensor sensors;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const int log = windows[w].rows.log->number;
    std::map<LogChannel, ErrorSeries> series;
    const std::vector<Sample>& samples = windows[w].samples();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Sample& sample = samples[i];
      series[sample.channel].error.push_back(errors[w].raw(eigen_index(i)));
      series[sample.channel].since_s.push_back(sample.since_s);
    }
    for (auto& [channel, part] : series) {
      sensors[sensor_in(problem.model.noise, channel, log).first].push_back(std::move(part));
    }
  }
  return sensors;
}

/// Clips the errors of one sensor at three standard deviations, which are estimated by the median.
void clip(std::vector<ErrorSeries>& sensor) {
  std::vector<double> all;
  for (const ErrorSeries& part : sensor) append(all, part.error);
  const Eigen::Map<const Eigen::VectorXd> errors(all.data(), rows_of(all));
  const double limit = 3.0 * median_scale(errors);
  for (ErrorSeries& part : sensor) {
    for (double& e : part.error) e = std::clamp(e, -limit, limit);
  }
}

}  // namespace

ErrorsBySensor errors_by_sensor(const LogProblem& problem,
                                const std::vector<WindowErrors>& errors) {
  ErrorsBySensor sensors = by_sensor(problem, errors);
  if (problem.loss == Loss::kSquared) return sensors;
  for (auto& [sensor, parts] : sensors) clip(parts);
  return sensors;
}

namespace {

NoiseLevels noise_levels(const LogProblem& problem, const std::vector<WindowErrors>& errors) {
  const ErrorsBySensor sensors = errors_by_sensor(problem, errors);
  const double spent = static_cast<double>(problem.unknowns());
  const double free_share = std::max(0.1, 1.0 - spent / problem.readings());
  const std::vector<std::pair<LogSensor, ChannelNoise>> before(problem.model.noise.begin(),
                                                               problem.model.noise.end());
  std::vector<ChannelNoise> after(before.size());
  parallel_for(before.size(), problem.threads, [&](std::size_t i) {
    after[i] = likeliest_noise(sensors.at(before[i].first), free_share, before[i].second);
  });
  NoiseLevels levels;
  for (std::size_t i = 0; i < before.size(); ++i) levels[before[i].first] = after[i];
  return levels;
}

/// Largest change of the noise model of any sensor from `before` to `after`. The change of a sensor
/// is the largest of these numbers:
///   - the relative change of the total standard deviation;
///   - the change of the standard deviation of the drift, relative to the total standard deviation;
///   - the change of theta of differenced noise;
///   - a tenth of the relative change of the correlation time, if the drift is above a tenth of the
///     total noise.
double largest_change(const NoiseLevels& before, const NoiseLevels& after) {
  double change = 0.0;
  for (const auto& [sensor, noise] : after) {
    const ChannelNoise& old = before.at(sensor);
    const double std = noise.std();
    change = std::max({change, std::abs(std / old.std() - 1.0),
                       std::abs(noise.drift_std - old.drift_std) / std,
                       std::abs(noise.differenced - old.differenced)});
    if (noise.drift_std > 0.1 * std && old.drift_std > 0.1 * old.std()) {
      change = std::max(change, 0.1 * std::abs(std::log(noise.correlation_s / old.correlation_s)));
    }
  }
  return change;
}

/// Square root of the weight that a robust loss gives to the standardised residual r. The constants
/// give an efficiency of 95 % for normal errors. The weights are
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

void weigh(LogProblem& problem, const std::vector<WindowErrors>& errors) {
  if (problem.loss == Loss::kSquared) return;
  for (std::size_t w = 0; w < problem.windows.size(); ++w) {
    FitWindow& window = problem.windows[w];
    const int log = window.rows.log->number;
    window.weights.clear();
    for (std::size_t i = 0; i < window.samples().size(); ++i) {
      const LogChannel channel = window.samples()[i].channel;
      const double std = sensor_in(problem.model.noise, channel, log).second.std();
      window.weights.push_back(sqrt_weight(problem.loss, errors[w].raw(eigen_index(i)) / std));
    }
  }
}

}  // namespace

NoiseIteration settle_noise(LogProblem problem, SearchPoint point, const NoiseRounds& rounds) {
  constexpr double kSettled = 0.01;
  constexpr double kMiddling = 1e-6;
  const double fine_step_s = problem.model.longest_step_s;
  const double first_step_s = rounds.is_near ? fine_step_s : rough_step_s(problem.model);
  double first_cost = 0.0;
  double change_cost = 0.0;
  for (int round = 0; round < rounds.most; ++round) {
    problem.model.longest_step_s = round == 0 ? first_step_s : fine_step_s;
    Solved solved = solve(problem, std::move(point), kMiddling);
    point = std::move(solved.point);
    problem.model.longest_step_s = fine_step_s;
    if (round == 0) first_cost = solved.cost;
    if (first_cost > rounds.give_up_above) {
      return {std::move(problem), std::move(point), first_cost, change_cost, true};
    }
    const std::vector<WindowErrors> errors = errors_at(problem, point);
    if (!all_finite(errors)) break;  // simulation diverged; fit_logs() refuses such a fit
    const NoiseLevels levels = noise_levels(problem, errors);
    const double change = largest_change(problem.model.noise, levels);
    problem.model.noise = levels;
    change_cost = change_cost_of(errors);
    weigh(problem, errors);
    if (change < kSettled && (round > 0 || rounds.is_near)) break;
  }
  return {std::move(problem), std::move(point), first_cost, change_cost};
}

}  // namespace awmr
