#include "awmr/tune/robust.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/core/units.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/tune/goals.h"

namespace awmr {
namespace {

/// Median, 95 % quantile (the least value that as many do not exceed) and mean of the worst.
JudgedFigure figure_of(const std::string& name, std::vector<double> values, double tail_share) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const auto quantile = [&](double p) {
    return values[std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(p * n))) - 1];
  };
  const auto tail = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(tail_share * n)));
  const double worst = std::accumulate(values.end() - eigen_index(tail), values.end(), 0.0);
  return {name, quantile(0.5), quantile(0.95), worst / static_cast<double>(tail)};
}

/// What all draws in all scenarios make of one set of gains in one mode.
JudgedGains judged(const JudgedRuns& runs, YawMode mode, double tail_share) {
  JudgedGains result{.gains = runs.gains, .mode = mode, .figures = {}};
  std::array<std::vector<double>, kRunFigures> values;
  int completed = 0;
  for (const RunOutcome& outcome : runs.outcomes) {
    if (outcome.mode != mode) continue;
    completed += outcome.completed ? 1 : 0;
    for (std::size_t i = 0; i < kRunFigures; ++i) values[i].push_back(outcome.figures[i]);
  }
  result.completed_share = completed / static_cast<double>(values.front().size());
  const std::vector<std::string> names = run_figure_names();
  for (std::size_t i = 0; i < kRunFigures; ++i) {
    result.figures.push_back(figure_of(names[i], std::move(values[i]), tail_share));
  }
  return result;
}

}  // namespace

Result<std::vector<Plant<double>>> plants_of(const Model& model, std::span<const int> numbers,
                                             std::uint64_t seed) {
  AWMR_ASSIGN_OR_RETURN(const Plant<double> own, model.plant());
  std::vector<Plant<double>> plants(numbers.size() + 1, own);
  if (model.covariance.parameters.empty()) return plants;
  AWMR_ASSIGN_OR_RETURN(const PlantSampler sampler, PlantSampler::make(model));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    AWMR_ASSIGN_OR_RETURN(plants[i + 1], sampler.draw(seed, numbers[i]));
  }
  return plants;
}

Result<std::vector<Plant<double>>> plants_of(const Model& model, int draws, std::uint64_t seed) {
  std::vector<int> numbers(at(draws));
  std::iota(numbers.begin(), numbers.end(), 1);
  return plants_of(model, numbers, seed);
}

std::vector<JudgedRuns> run_candidates(const ObjectiveSetting& setting,
                                       const std::vector<NamedCandidate>& candidates) {
  const std::size_t of_own = yaw_modes(setting.vehicle).size() * setting.scenarios.size();
  std::vector<JudgedRuns> runs;
  for (const NamedCandidate& candidate : candidates) {
    const auto scores = run_all(setting, std::span(&candidate.gains, 1)).front();
    runs.push_back(
        {candidate.name, outcomes_of(std::span(scores).subspan(of_own), setting.scenarios)});
  }
  return runs;
}

Judgement judgement_of(const std::vector<JudgedRuns>& runs, const JudgedBy& by) {
  Judgement judgement;
  for (const JudgedRuns& of_gains : runs) {
    for (const YawMode mode : by.modes) {
      judgement.gains.push_back(judged(of_gains, mode, by.tail_share));
    }
    for (const GoalInMode& one : by_mode(by.goals, by.modes)) {
      judgement.goals.push_back(judged_goal(one, of_gains, by.scenarios));
    }
  }
  return judgement;
}

}  // namespace awmr
