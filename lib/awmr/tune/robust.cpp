#include "awmr/tune/robust.h"

#include <algorithm>
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
JudgedFigure figure_of(const char* name, std::vector<double> values, double tail_share) {
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
JudgedGains judged(const ObjectiveSetting& setting, const char* gains, YawMode mode,
                   std::span<const ModeScore> all) {
  std::vector<const ModeScore*> scores;
  for (const ModeScore& score : all) {
    if (score.mode == mode) scores.push_back(&score);
  }
  const auto completed =
      std::ranges::count_if(scores, [](const ModeScore* s) { return s->metrics.completed; });
  JudgedGains result{
      .gains = gains,
      .mode = mode,
      .completed_share = static_cast<double>(completed) / static_cast<double>(scores.size()),
      .figures = {}};
  for (const RunFigure& by : run_figures()) {
    std::vector<double> values;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      values.push_back(by.value(*scores[i], setting.scenarios[i % setting.scenarios.size()]));
    }
    result.figures.push_back(figure_of(by.name, std::move(values), setting.tail_share));
  }
  return result;
}

}  // namespace

Result<std::vector<Plant<double>>> plants_of(const Model& model, int draws, std::uint64_t seed) {
  AWMR_ASSIGN_OR_RETURN(const Plant<double> own, model.plant());
  std::vector<Plant<double>> plants(at(draws) + 1, own);
  if (model.covariance.parameters.empty()) return plants;
  AWMR_ASSIGN_OR_RETURN(const PlantSampler sampler, PlantSampler::make(model));
  for (int draw = 1; draw <= draws; ++draw) {
    AWMR_ASSIGN_OR_RETURN(plants[at(draw)], sampler.draw(seed, draw));
  }
  return plants;
}

Judgement judge(const ObjectiveSetting& setting, const std::vector<NamedCandidate>& candidates) {
  const std::span<const YawMode> modes = yaw_modes(setting.vehicle);
  const std::size_t of_own = modes.size() * setting.scenarios.size();
  Judgement judgement;
  for (const NamedCandidate& candidate : candidates) {
    const auto all = run_all(setting, std::span(&candidate.gains, 1)).front();
    const auto scores = std::span(all).subspan(of_own);
    for (const YawMode mode : modes) {
      judgement.gains.push_back(judged(setting, candidate.name, mode, scores));
    }
    for (const GoalInMode& one : by_mode(setting.goals, modes)) {
      judgement.goals.push_back(judged_goal(one, candidate.name, scores, setting.scenarios));
    }
  }
  return judgement;
}

}  // namespace awmr
