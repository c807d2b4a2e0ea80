#include "awmr/tune/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/binomial.h"

namespace awmr {
namespace {

constexpr RunFigure kRunFigures[] = {
    {"settling_time_s",
     [](const ModeScore& s, const Scenario& scenario) {
       return s.metrics.settling_time_s.value_or(scenario.duration_s);
     }},
    {"overshoot_deg",
     [](const ModeScore& s, const Scenario&) { return s.metrics.overshoot_deg.value_or(0.0); }},
    {"heading_iae_degs",
     [](const ModeScore& s, const Scenario&) { return s.metrics.heading_iae_degs.value_or(0.0); }},
    {"heading_itae_degs2",
     [](const ModeScore& s, const Scenario&) {
       return s.metrics.heading_itae_degs2.value_or(0.0);
     }},
    {"control_variation",
     [](const ModeScore& s, const Scenario&) { return s.metrics.control_variation; }},
    {"steering_rate_rms_degps",
     [](const ModeScore& s, const Scenario&) { return s.metrics.steering_rate_rms_degps; }},
};

const RunFigure& figure_named(std::string_view name) {
  return *std::find_if(std::begin(kRunFigures), std::end(kRunFigures),
                       [&](const RunFigure& figure) { return figure.name == name; });
}

/// Of each draw the largest excess in the mode over the scenarios: they share its plant, so that their runs are
/// no trials of their own. Scores are by draw, then mode, then scenario.
std::vector<double> excesses(const GoalInMode& one, std::span<const ModeScore> scores,
                             std::span<const Scenario> scenarios) {
  std::vector<double> all;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i].mode != one.mode) continue;
    const std::size_t scenario = i % scenarios.size();
    if (scenario == 0) all.push_back(0.0);
    all.back() = std::max(all.back(), excess_of(*one.goal, scores[i], scenarios[scenario]));
  }
  return all;
}

}  // namespace

std::span<const RunFigure> run_figures() { return kRunFigures; }

double figure_of_run(std::string_view name, const ModeScore& score, const Scenario& scenario) {
  return figure_named(name).value(score, scenario);
}

bool is_run_figure(std::string_view name) {
  return std::any_of(std::begin(kRunFigures), std::end(kRunFigures),
                     [&](const RunFigure& figure) { return figure.name == name; });
}

std::vector<std::string> run_figure_names() {
  std::vector<std::string> names;
  for (const RunFigure& figure : kRunFigures) names.emplace_back(figure.name);
  return names;
}

std::string in_words(const TuningGoal& goal) {
  std::string text;
  for (const GoalLimit& limit : goal.at_most) {
    text += fmt::format("{}{} <= {:g}", text.empty() ? "" : ", ", limit.figure, limit.most);
  }
  return fmt::format("{} in {:g} % of draws", text, 100.0 * goal.share);
}

double excess_of(const TuningGoal& goal, const ModeScore& score, const Scenario& scenario) {
  if (score.has_failed) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (const GoalLimit& limit : goal.at_most) {
    const double share = figure_of_run(limit.figure, score, scenario) / limit.most;
    // A figure that is no number is no figure that holds.
    largest =
        std::isnan(share) ? std::numeric_limits<double>::infinity() : std::max(largest, share);
  }
  return largest;
}

std::string GoalInMode::name() const {
  return fmt::format("{}, {}", in_words(*goal), name_of(mode));
}

std::vector<GoalInMode> by_mode(std::span<const TuningGoal> goals, std::span<const YawMode> modes) {
  std::vector<GoalInMode> all;
  for (const TuningGoal& goal : goals) {
    for (const YawMode mode : modes) {
      if (!goal.mode || *goal.mode == mode) all.push_back({&goal, mode});
    }
  }
  return all;
}

double quantile_of_excess(const GoalInMode& one, std::span<const ModeScore> scores,
                          std::span<const Scenario> scenarios) {
  std::vector<double> all = excesses(one, scores, scenarios);
  const auto n = static_cast<double>(all.size());
  const auto rank =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(one.goal->share * n - 1e-9)));
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(all.begin(), at, all.end());
  return *at;
}

JudgedGoal judged_goal(const GoalInMode& one, const char* gains, std::span<const ModeScore> scores,
                       std::span<const Scenario> scenarios) {
  const std::vector<double> all = excesses(one, scores, scenarios);
  const auto held = static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](double excess) { return excess <= 1.0; }));
  JudgedGoal judged{.goal = *one.goal,
                    .mode = one.mode,
                    .gains = gains,
                    .held = static_cast<int>(held),
                    .runs = static_cast<int>(all.size()),
                    .ci95 = clopper_pearson(held, all.size()),
                    .verdict = GoalVerdict::kOpen};
  if (judged.ci95.lo >= one.goal->share) judged.verdict = GoalVerdict::kMet;
  if (judged.ci95.hi < one.goal->share) judged.verdict = GoalVerdict::kMissed;
  return judged;
}

}  // namespace awmr
