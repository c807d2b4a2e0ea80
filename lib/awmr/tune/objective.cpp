#include "awmr/tune/objective.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>
#include <ranges>
#include <span>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/parallel.h"
#include "awmr/simulate/meter.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/goals.h"

namespace awmr {
namespace {

/// The number of runs per batch is a multiple of this, so that few lanes of the vector registers
/// stay empty: a register holds two (NEON), four (AVX2) or eight (AVX-512) runs.
constexpr std::size_t kFour = 4;

/// Returns the number of runs per batch, small enough that every thread gets a batch. `count`:
/// number of runs in each scenario.
std::size_t runs_together(std::size_t count, std::size_t scenarios) {
  const std::size_t share = count * scenarios / thread_count(0) + 1;
  return std::min(kBatchRuns, (share + kFour - 1) / kFour * kFour);
}

/// The runs of one scenario, sorted by gains, then vehicle, then mode.
std::vector<BatchRun> runs_of(const ObjectiveSetting& setting,
                              std::span<const Gains<double>> gains) {
  std::vector<BatchRun> runs;
  Vehicle vehicle = setting.vehicle;
  for (const Gains<double>& one : gains) {
    for (std::size_t i = 0; i < setting.vehicles.size(); ++i) {
      const DrawnVehicle& drawn = setting.vehicles[i];
      vehicle.wheel_force = drawn.wheel_force;
      const auto controller = make_controller(setting.vehicles.front().plant, vehicle, one);
      for (const YawMode mode : setting.modes()) {
        runs.push_back({drawn.plant, controller, mode, setting.seed, i});
      }
    }
  }
  return runs;
}

/// Mean of the values. The result has the same bits for every order of the values.
double mean_in_any_order(std::vector<double> values) {
  std::ranges::sort(values);
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

std::array<double, std::size(kObjectiveTerms)> figures_of(const ModeScore& score) {
  const Metrics& m = score.metrics;
  return {m.settling_time_s.value_or(score.unsettled_s),
          m.heading_itae_degs2.value_or(0.0),
          m.overshoot_deg.value_or(0.0),
          m.control_variation,
          m.control_effort,
          m.speed_itae_m_s};
}

double unsettled_s(const Scenario& scenario, double itae_degs2) {
  double in_band_degs2 = 0.0;
  double end_s = scenario.duration_s;
  for (const HeadingStep& step :
       std::views::reverse(std::get<HeadingSteps>(scenario.guidance).steps)) {
    const double held_s = std::max(end_s - step.t_s, 0.0);
    in_band_degs2 += meter::kSettledLeastDeg * held_s * held_s / 2.0;
    end_s = step.t_s;
  }
  return scenario.duration_s * std::max(1.0, itae_degs2 / in_band_degs2);
}

double objective_of(const ModeScore& score, const ModeScore& baseline,
                    const ObjectiveWeights& weights) {
  const auto x = figures_of(score);
  const auto x0 = figures_of(baseline);
  double sum = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double weight = weights.*kObjectiveTerms[i].weight;
    const double floor = kObjectiveTerms[i].floor;
    sum += weight * std::log((x[i] + floor) / (x0[i] + floor));  // exactly 0 where x = x0
    total += weight;
  }
  return std::exp(sum / total);
}

double mean_and_tail(std::vector<double> values, double tail_share) {
  std::sort(values.begin(), values.end(), std::greater<>());
  const auto n = static_cast<double>(values.size());
  const auto tail = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(tail_share * n)));
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  const double worst = std::accumulate(values.begin(), values.begin() + eigen_index(tail), 0.0) /
                       static_cast<double>(tail);
  return 0.5 * (mean + worst);
}

std::span<const YawMode> tuned_modes(const Vehicle& vehicle, std::optional<YawMode> mode) {
  const std::span<const YawMode> all = yaw_modes(vehicle);
  if (!mode) return all;
  return all.subspan(static_cast<std::size_t>(std::ranges::find(all, *mode) - all.begin()), 1);
}

RunNoise draw_noise(const ObjectiveSetting& setting) {
  const std::size_t vehicles = setting.vehicles.size();
  double bytes = 0.0;
  for (const Scenario& scenario : setting.scenarios) {
    const double samples = scenario.duration_s / setting.vehicle.sample_time_s;
    bytes += 3.0 * sizeof(double) * samples * static_cast<double>(vehicles);
  }
  if (bytes > kMaxNoiseBytes) return {};
  RunNoise noise(setting.scenarios.size(), std::vector<DrawnNoise>(vehicles));
  parallel_for(setting.scenarios.size() * vehicles, 0, [&](std::size_t i) {
    const std::size_t scenario = i / vehicles;
    noise[scenario][i % vehicles] = draw_sensor_noise(
        setting.scenarios[scenario], setting.vehicle.sample_time_s, setting.seed, i % vehicles);
  });
  return noise;
}

std::vector<std::vector<ModeScore>> run_all(const ObjectiveSetting& setting, const RunNoise& noise,
                                            std::span<const Gains<double>> gains) {
  if (gains.empty()) return {};
  const std::vector<BatchRun> runs = runs_of(setting, gains);
  const std::size_t modes = setting.modes().size();
  const std::size_t scenarios = setting.scenarios.size();
  const std::size_t together = runs_together(runs.size(), scenarios);
  const std::size_t blocks = (runs.size() + together - 1) / together;
  const std::size_t per_gains = runs.size() / gains.size();
  std::vector<std::vector<ModeScore>> scores(gains.size(),
                                             std::vector<ModeScore>(per_gains * scenarios));
  parallel_for(blocks * scenarios, 0, [&](std::size_t i) {
    const Scenario& scenario = setting.scenarios[i % scenarios];
    const std::size_t first = i / scenarios * together;
    const std::size_t count = std::min(together, runs.size() - first);
    std::vector<BatchRun> block(runs.begin() + eigen_index(first),
                                runs.begin() + eigen_index(first + count));
    for (std::size_t j = 0; j < count && !noise.empty(); ++j) {
      block[j].noise = &noise[i % scenarios][(first + j) % per_gains / modes];
    }
    const double sample_time_s = setting.vehicle.sample_time_s;
    const auto driven = simulate_batch(block, scenario, sample_time_s, setting.arithmetic);
    for (std::size_t j = 0; j < block.size(); ++j) {
      const std::size_t run = first + j;
      const Metrics& found = driven[j].metrics;
      scores[run / per_gains][run % per_gains * scenarios + i % scenarios] = {
          .scenario = scenario.name,
          .mode = block[j].mode,
          .metrics = found,
          .unsettled_s = unsettled_s(scenario, found.heading_itae_degs2.value_or(0.0)),
          .has_failed = driven[j].run.end == RunEnd::kFailed};
    }
  });
  return scores;
}

Objective::Objective(ObjectiveSetting setting, const Gains<double>& baseline)
    : setting_(std::move(setting)),
      noise_(draw_noise(setting_)),
      baseline_scores_(run_all(setting_, noise_, std::span(&baseline, 1)).front()) {
  baseline_ = evaluate(baseline_scores_);
  known_.emplace(std::bit_cast<GainNumbers>(baseline), baseline_);
}

std::vector<Evaluation> Objective::operator()(std::span<const Gains<double>> gains) const {
  std::map<GainNumbers, Evaluation> unknown;
  {
    const std::lock_guard lock(known_mutex_);
    for (const Gains<double>& one : gains) {
      const auto numbers = std::bit_cast<GainNumbers>(one);
      if (!known_.contains(numbers)) unknown.try_emplace(numbers);
    }
  }
  std::vector<Gains<double>> to_run;
  for (const auto& [numbers, evaluation] : unknown) {
    to_run.push_back(std::bit_cast<Gains<double>>(numbers));
  }
  auto scores = run_all(setting_, noise_, to_run);
  std::size_t next = 0;
  for (auto& [numbers, evaluation] : unknown) evaluation = evaluate(std::move(scores[next++]));
  const std::lock_guard lock(known_mutex_);
  known_.merge(std::move(unknown));
  std::vector<Evaluation> evaluations;
  for (const Gains<double>& one : gains) {
    evaluations.push_back(known_.at(std::bit_cast<GainNumbers>(one)));
  }
  return evaluations;
}

Evaluation Objective::operator()(const Gains<double>& gains) const {
  return (*this)(std::span(&gains, 1)).front();
}

/// Adds the control variation of one mode to `evaluation`. Returns the logarithm of the mode's
/// objective. The scores are sorted by vehicle, then mode, then scenario.
double Objective::evaluate_mode(std::span<const ModeScore> scores, std::size_t mode,
                                Evaluation& evaluation) const {
  const std::size_t scenarios = setting_.scenarios.size();
  double log_objective = 0.0;
  double variation = 0.0;
  double of_baseline = 0.0;
  for (std::size_t scenario = 0; scenario < scenarios; ++scenario) {
    std::vector<double> by_vehicle;
    for (std::size_t i = mode * scenarios + scenario; i < scores.size();
         i += setting_.modes().size() * scenarios) {
      by_vehicle.push_back(std::log(scores[i].objective));
      variation += scores[i].metrics.control_variation;
      of_baseline += baseline_scores_[i].metrics.control_variation;
    }
    log_objective += mean_and_tail(std::move(by_vehicle), setting_.tail_share);
  }
  evaluation.mode_activity.push_back(of_baseline > 0.0 ? variation / of_baseline : 1.0);
  return log_objective / static_cast<double>(scenarios);
}

TradeOffPoint Objective::trade_off(std::span<const ModeScore> scores) const {
  std::vector<double> settling_s, control_variation;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Metrics& metrics = scores[i].metrics;
    const Scenario& scenario = setting_.scenarios[i % setting_.scenarios.size()];
    settling_s.push_back(metrics.settling_time_s.value_or(scenario.duration_s));
    control_variation.push_back(metrics.control_variation);
  }
  return {mean_in_any_order(std::move(settling_s)),
          mean_in_any_order(std::move(control_variation))};
}

Evaluation Objective::evaluate(std::vector<ModeScore> scores) const {
  const std::size_t scenarios = setting_.scenarios.size();
  const std::size_t modes = setting_.modes().size();
  Evaluation evaluation;
  evaluation.valid = true;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    ModeScore& s = scores[i];
    s.objective = objective_of(s, baseline_scores_[i], setting_.weights);
    if (!std::isfinite(s.objective) || s.has_failed) evaluation.valid = false;
  }
  double log_of_all = 0.0;
  for (std::size_t mode = 0; mode < modes; ++mode) {
    log_of_all += evaluate_mode(scores, mode, evaluation);
  }
  evaluation.objective = std::exp(log_of_all / static_cast<double>(modes));
  const std::vector<RunOutcome> outcomes =
      setting_.goals.empty() ? std::vector<RunOutcome>{} : outcomes_of(scores, setting_.scenarios);
  for (const GoalInMode& one : by_mode(setting_.goals, setting_.modes())) {
    const double quantile = quantile_of_excess(one, outcomes, scenarios);
    evaluation.goal_quantile.push_back(quantile);
    if (one.goal->is_soft) evaluation.objective += std::max(0.0, quantile - 1.0);
  }
  if (!std::isfinite(evaluation.objective)) evaluation.valid = false;
  evaluation.trade_off = trade_off(scores);
  scores.resize(modes * scenarios);
  evaluation.scores = std::move(scores);
  return evaluation;
}

}  // namespace awmr
