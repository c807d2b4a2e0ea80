#include "awmr/tune/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/statistics/binomial.h"
#include "awmr/core/statistics/sample_quantile.h"

namespace awmr {
namespace {

/// A metric of one run; larger is worse.
struct RunFigure {
  const char* name;
  double (*value)(const Metrics& metrics, const Scenario& scenario);
};
constexpr RunFigure kFiguresByName[kRunFigures] = {
    {"settling_time_s",
     [](const Metrics& m, const Scenario& scenario) {
       return m.settling_time_s.value_or(scenario.duration_s);
     }},
    {"overshoot_deg",
     [](const Metrics& m, const Scenario&) { return m.overshoot_deg.value_or(0.0); }},
    {"heading_iae_degs",
     [](const Metrics& m, const Scenario&) { return m.heading_iae_degs.value_or(0.0); }},
    {"heading_itae_degs2",
     [](const Metrics& m, const Scenario&) { return m.heading_itae_degs2.value_or(0.0); }},
    {"control_variation", [](const Metrics& m, const Scenario&) { return m.control_variation; }},
    {"steering_rate_rms_degps",
     [](const Metrics& m, const Scenario&) { return m.steering_rate_rms_degps; }},
};

/// Returns for each drawn vehicle its excess in one mode, the largest ratio of a metric to its
/// limit (goals.h). The runs of one vehicle are not independent, so a vehicle counts once, with the
/// largest excess over the scenarios. `outcomes` are sorted by vehicle, then mode, then scenario.
std::vector<double> excesses(const GoalInMode& one, std::span<const RunOutcome> outcomes,
                             std::size_t scenarios) {
  std::vector<double> all;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].mode != one.mode) continue;
    if (i % scenarios == 0) all.push_back(0.0);
    all.back() = std::max(all.back(), excess_of(*one.goal, outcomes[i]));
  }
  return all;
}

/// Value that replaces a metric that is not finite: larger than any limit, and representable in
/// JSON.
constexpr double kNoFigure = 1e100;

/// Value of a metric in one run. Precondition: a metric with this name exists.
double figure_of_run(std::string_view name, const RunOutcome& outcome) {
  const auto* figure =
      std::ranges::find_if(kFiguresByName, [&](const RunFigure& one) { return one.name == name; });
  return outcome.figures[static_cast<std::size_t>(figure - std::begin(kFiguresByName))];
}

}  // namespace

RunOutcome outcome_of(const ModeScore& score, const Scenario& scenario) {
  RunOutcome outcome{
      .mode = score.mode, .completed = score.metrics.completed, .broke_off = score.has_failed};
  for (std::size_t i = 0; i < kRunFigures; ++i) {
    const double figure = kFiguresByName[i].value(score.metrics, scenario);
    outcome.figures[i] = std::isfinite(figure) ? figure : kNoFigure;
  }
  return outcome;
}

std::vector<RunOutcome> outcomes_of(std::span<const ModeScore> scores,
                                    std::span<const Scenario> scenarios) {
  std::vector<RunOutcome> outcomes;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    outcomes.push_back(outcome_of(scores[i], scenarios[i % scenarios.size()]));
  }
  return outcomes;
}

std::vector<std::string> run_figure_names() {
  std::vector<std::string> names;
  for (const RunFigure& figure : kFiguresByName) names.emplace_back(figure.name);
  return names;
}

std::string in_words(const TuningGoal& goal) {
  std::string text;
  for (const GoalLimit& limit : goal.at_most) {
    text += fmt::format("{}{} <= {:g}", text.empty() ? "" : ", ", limit.figure, limit.most);
  }
  return fmt::format("{} in {:g} % of draws", text, 100.0 * goal.share);
}

double excess_of(const TuningGoal& goal, const RunOutcome& outcome) {
  if (outcome.broke_off) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (const GoalLimit& limit : goal.at_most) {
    const double figure = figure_of_run(limit.figure, outcome);
    if (!(figure < kNoFigure)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, figure / limit.most);
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

double quantile_of_excess(const GoalInMode& one, std::span<const RunOutcome> outcomes,
                          std::size_t scenarios) {
  return rank_quantile(excesses(one, outcomes, scenarios), one.goal->share);
}

EvaluatedGoal evaluate_goal(const GoalInMode& one, const EvaluatedRuns& runs,
                            std::size_t scenarios) {
  const std::vector<double> all = excesses(one, runs.outcomes, scenarios);
  const auto held = static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](double excess) { return excess <= 1.0; }));
  EvaluatedGoal evaluated{.goal = *one.goal,
                          .mode = one.mode,
                          .gains = runs.gains,
                          .held = static_cast<int>(held),
                          .runs = static_cast<int>(all.size()),
                          .ci95 = clopper_pearson(held, all.size()),
                          .verdict = GoalVerdict::kOpen};
  if (evaluated.ci95.lo >= one.goal->share) evaluated.verdict = GoalVerdict::kMet;
  if (evaluated.ci95.hi < one.goal->share) evaluated.verdict = GoalVerdict::kMissed;
  return evaluated;
}

}  // namespace awmr
