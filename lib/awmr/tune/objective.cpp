#include "awmr/tune/objective.h"

#include <cmath>
#include <span>
#include <utility>

#include "awmr/core/parallel.h"
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

Objective::Objective(const Plant<double>& plant, const Vehicle& vehicle,
                     const ObjectiveWeights& weights, std::vector<Scenario> scenarios,
                     const Gains<double>& baseline)
    : plant_(plant), vehicle_(vehicle), weights_(weights), scenarios_(std::move(scenarios)) {
  Evaluation evaluation = simulate_all(baseline);
  score(evaluation, evaluation);
  baseline_ = std::move(evaluation);
}

Evaluation Objective::operator()(const Gains<double>& gains) const {
  Evaluation evaluation = simulate_all(gains);
  score(evaluation, baseline_);
  return evaluation;
}

std::vector<ModeScore> Objective::run(const Gains<double>& gains, YawMode mode) const {
  const Controller<double> controller = make_controller(plant_, vehicle_, gains);
  const SimulateOptions options{.sample_time_s = vehicle_.sample_time_s, .substeps = std::nullopt};
  std::vector<ModeScore> scores;
  for (const Scenario& scenario : scenarios_) {
    const Run run = simulate(plant_, controller, scenario, mode, options);
    scores.push_back({.scenario = scenario.name,
                      .mode = mode,
                      .metrics = metrics_of(run, scenario, controller),
                      .objective = 0.0,
                      .speed_itae_m_s = speed_itae_m_s(run)});
  }
  return scores;
}

Evaluation Objective::simulate_all(const Gains<double>& gains) const {
  const std::span<const YawMode> modes = yaw_modes(vehicle_);
  std::vector<std::vector<ModeScore>> by_mode(modes.size());
  // A thread per mode, also on fewer cores: they take about as long as each other.
  parallel_for(modes.size(), static_cast<int>(modes.size()),
               [&](std::size_t m) { by_mode[m] = run(gains, modes[m]); });
  Evaluation evaluation;
  for (std::vector<ModeScore>& scores : by_mode) {
    for (ModeScore& one : scores) evaluation.scores.push_back(std::move(one));
  }
  return evaluation;
}

void Objective::score(Evaluation& evaluation, const Evaluation& baseline) const {
  evaluation.valid = true;
  evaluation.mode_objective.assign(yaw_modes(vehicle_).size(), 0.0);
  for (std::size_t i = 0; i < evaluation.scores.size(); ++i) {
    ModeScore& s = evaluation.scores[i];
    const ModeScore& base = baseline.scores[i];
    s.objective = objective_of(s, base, weights_);
    if (!std::isfinite(s.objective)) evaluation.valid = false;
    if (base.metrics.completed && !s.metrics.completed) evaluation.valid = false;
    const std::size_t mode = i / scenarios_.size();
    evaluation.mode_objective[mode] += s.objective;
  }
  for (double& mode : evaluation.mode_objective) {
    mode /= static_cast<double>(scenarios_.size());
    evaluation.objective += mode;
  }
  evaluation.objective /= static_cast<double>(evaluation.mode_objective.size());
}

}  // namespace awmr
