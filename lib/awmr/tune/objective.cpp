#include "awmr/tune/objective.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/parallel.h"
#include "awmr/core/units.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

/// Integral of t |u_d - u| over the run, m s, by trapezoids.
double speed_itae_m_s(const Run& run) {
  double sum = 0.0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const RunRow& a = run.rows[i - 1];
    const RunRow& b = run.rows[i];
    sum += (b.t_s - a.t_s) / 2.0 *
           (a.t_s * std::abs(a.u_ref_mps - a.state.u_mps) +
            b.t_s * std::abs(b.u_ref_mps - b.state.u_mps));
  }
  return sum;
}

/// Of the commanded angle.
double steering_rate_rms_degps(const Run& run) {
  if (run.rows.size() < 2) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    const RunRow& a = run.rows[i - 1];
    const RunRow& b = run.rows[i];
    const double rate_degps =
        degrees(b.steering_command_rad - a.steering_command_rad) / (b.t_s - a.t_s);
    sum += rate_degps * rate_degps;
  }
  return std::sqrt(sum / static_cast<double>(run.rows.size() - 1));
}

}  // namespace

std::array<double, std::size(kObjectiveTerms)> figures_of(const ModeScore& score) {
  const Metrics& m = score.metrics;
  return {m.heading_itae_degs2.value_or(0.0), m.overshoot_deg.value_or(0.0), m.control_variation,
          m.control_effort, score.speed_itae_m_s};
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
    sum += weight * ((x[i] + floor) / (x0[i] + floor));  // exactly the weight where x = x0
    total += weight;
  }
  return sum / total;
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

std::vector<ModeScore> run_scenarios(const ObjectiveSetting& setting, std::size_t plant,
                                     const Gains<double>& gains, YawMode mode) {
  const Controller<double> controller =
      make_controller(setting.plants.front(), setting.vehicle, gains);
  const SimulateOptions options{.sample_time_s = setting.vehicle.sample_time_s,
                                .substeps = std::nullopt,
                                .seed = setting.seed,
                                .sample = plant};
  std::vector<ModeScore> scores;
  for (const Scenario& scenario : setting.scenarios) {
    const Run run = simulate(setting.plants[plant], controller, scenario, mode, options);
    scores.push_back({.scenario = scenario.name,
                      .mode = mode,
                      .metrics = metrics_of(run, scenario, controller),
                      .objective = 0.0,
                      .speed_itae_m_s = speed_itae_m_s(run),
                      .steering_rate_rms_degps = steering_rate_rms_degps(run)});
  }
  return scores;
}

Objective::Objective(ObjectiveSetting setting, const Gains<double>& baseline)
    : setting_(std::move(setting)), baseline_scores_(simulate_all(baseline)) {
  baseline_ = evaluate(baseline_scores_);
}

Evaluation Objective::operator()(const Gains<double>& gains) const {
  return evaluate(simulate_all(gains));
}

std::vector<ModeScore> Objective::simulate_all(const Gains<double>& gains) const {
  const std::span<const YawMode> modes = yaw_modes(setting_.vehicle);
  std::vector<std::vector<ModeScore>> runs(setting_.plants.size() * modes.size());
  parallel_for(runs.size(), 0, [&](std::size_t i) {
    runs[i] = run_scenarios(setting_, i / modes.size(), gains, modes[i % modes.size()]);
  });
  std::vector<ModeScore> scores;
  for (std::vector<ModeScore>& run : runs) {
    for (ModeScore& one : run) scores.push_back(std::move(one));
  }
  return scores;
}

Evaluation Objective::evaluate(std::vector<ModeScore> scores) const {
  const std::size_t scenarios = setting_.scenarios.size();
  const std::size_t modes = yaw_modes(setting_.vehicle).size();
  const std::size_t per_plant = modes * scenarios;
  Evaluation evaluation;
  evaluation.valid = true;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    ModeScore& s = scores[i];
    s.objective = objective_of(s, baseline_scores_[i], setting_.weights);
    if (!std::isfinite(s.objective)) evaluation.valid = false;
    if (baseline_scores_[i].metrics.completed && !s.metrics.completed) evaluation.valid = false;
  }
  for (std::size_t mode = 0; mode < modes; ++mode) {
    double objective = 0.0;
    double variation = 0.0;
    double of_baseline = 0.0;
    for (std::size_t scenario = 0; scenario < scenarios; ++scenario) {
      std::vector<double> by_plant;
      for (std::size_t i = mode * scenarios + scenario; i < scores.size(); i += per_plant) {
        by_plant.push_back(scores[i].objective);
        variation += scores[i].metrics.control_variation;
        of_baseline += baseline_scores_[i].metrics.control_variation;
      }
      objective += mean_and_tail(std::move(by_plant), setting_.tail_share);
    }
    evaluation.mode_objective.push_back(objective / static_cast<double>(scenarios));
    evaluation.mode_activity.push_back(of_baseline > 0.0 ? variation / of_baseline : 1.0);
    evaluation.objective += evaluation.mode_objective.back();
  }
  evaluation.objective /= static_cast<double>(modes);
  scores.resize(per_plant);
  evaluation.scores = std::move(scores);
  return evaluation;
}

}  // namespace awmr
