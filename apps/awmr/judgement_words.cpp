#include "judgement_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "awmr/simulate/validity.h"
#include "commands.h"

namespace awmr::cli {

std::string judged_table(const std::vector<JudgedGains>& all,
                         const std::vector<JudgedGains>& by_scenario) {
  if (all.empty()) return {};
  const std::vector<JudgedGains>& rows = by_scenario.empty() ? all : by_scenario;
  std::string text =
      fmt::format("  {:<13} {:<9} {:>8} {:>10} {:>10} {:>10} {:>11}\n", "fresh draws", "gains",
                  "settled", "settling s", "overs. deg", "IAE deg s", "steer deg/s");
  text += fmt::format("  {:<13} {:<9} {:>8} {:>10} {:>10} {:>10} {:>11}\n", "", "", "%", "95 %",
                      "95 %", "95 %", "RMS, 95 %");
  std::string_view scenario;
  for (const JudgedGains& judged : rows) {
    if (judged.scenario != scenario) text += fmt::format("  {}\n", judged.scenario);
    scenario = judged.scenario;
    const auto q95 = [&](std::string_view name) {
      const auto figure = std::find_if(judged.figures.begin(), judged.figures.end(),
                                       [&](const JudgedFigure& f) { return f.name == name; });
      return figure->q95;
    };
    text += fmt::format("  {:<13} {:<9} {:>8.0f} {:>10.2f} {:>10.2f} {:>10.1f} {:>11.1f}\n",
                        name_of(judged.mode), judged.gains, 100.0 * judged.completed_share,
                        q95("settling_time_s"), q95("overshoot_deg"), q95("heading_iae_degs"),
                        q95("steering_rate_rms_degps"));
  }
  return text;
}

std::string goals_text(const std::vector<JudgedGoal>& all) {
  std::string text;
  for (const JudgedGoal& judged : all) {
    if (judged.gains != "robust") continue;
    std::string limits;
    for (const GoalLimit& limit : judged.goal.at_most) {
      limits += fmt::format("{}{} <= {:g}", limits.empty() ? "" : ", ", limit.figure, limit.most);
    }
    text += fmt::format(
        "  {:<6} {}, {}{}: {:.1f} % of {} draws ({:.1f} to {:.1f}), required {:g} %\n",
        name_in(kGoalVerdictNames, judged.verdict), limits, name_of(judged.mode),
        judged.goal.is_soft ? ", soft" : "", 100.0 * judged.held / judged.runs, judged.runs,
        100.0 * judged.ci95.lo, 100.0 * judged.ci95.hi, 100.0 * judged.goal.share);
  }
  return text.empty() ? text : "  goals, on fresh draws\n" + text;
}

std::vector<Finding> goal_findings(const std::vector<JudgedGoal>& all) {
  std::vector<Finding> findings;
  for (const JudgedGoal& judged : all) {
    if (judged.gains != "robust" || judged.verdict == GoalVerdict::kMet) continue;
    const bool is_missed = judged.verdict == GoalVerdict::kMissed;
    findings.push_back(
        {"", 0, Severity::kWarning, is_missed ? "goal-missed" : "goal-open",
         fmt::format("{} of {} fresh draws in {} meet the goal ({:.1f} to {:.1f} %), {:g} % are "
                     "required: {}",
                     judged.held, judged.runs, name_of(judged.mode), 100.0 * judged.ci95.lo,
                     100.0 * judged.ci95.hi, 100.0 * judged.goal.share,
                     is_missed ? "tune on more draws (--draws), raise the limits or accept less"
                               : "increase judged_draws")});
  }
  return findings;
}

void note_unsettled(const std::string& scenario, YawMode mode, double completed_share,
                    std::vector<Finding>& findings) {
  constexpr double kMinShare = 0.95;
  if (completed_share >= kMinShare) return;
  findings.push_back(
      {"", 0, Severity::kWarning, "unsettled",
       fmt::format("{}{}: only {:.0f} % of the runs with the tuned gains settle after every step; "
                   "the metrics of the others are of unsettled runs. Give more time or a higher "
                   "heading-rate limit, or add an observer (--observer) against constant "
                   "disturbances",
                   scenario.empty() ? "" : scenario + ", ", name_of(mode),
                   100.0 * completed_share)});
}

std::vector<Finding> extrapolation_findings(const Comparison& comparison,
                                            const Provenance& provenance) {
  if (!comparison.measured_yaw_rate_degps || comparison.rows.empty()) return {};
  const auto fastest = std::ranges::max_element(
      comparison.rows, {}, [](const ComparisonRow& row) { return row.metrics.yaw_rate_max_degps; });
  const bool is_rate_limited =
      std::ranges::find(provenance.options,
                        std::pair(std::string(kRateName), std::string(kMeasuredRate))) !=
      provenance.options.end();
  const std::string model = provenance.inputs.empty() ? "" : provenance.inputs.front().name;
  auto finding = extrapolation_finding(
      model, *comparison.measured_yaw_rate_degps, fastest->metrics.yaw_rate_max_degps,
      fmt::format("{}, {}, sample {}", fastest->scenario, name_of(fastest->mode), fastest->sample),
      is_rate_limited);
  if (!finding) return {};
  return {*std::move(finding)};
}

std::vector<Finding> unsettled_findings(const std::vector<JudgedGains>& all,
                                        const std::vector<JudgedGains>& by_scenario) {
  std::vector<Finding> findings;
  for (const JudgedGains& one : by_scenario.empty() ? all : by_scenario) {
    if (one.gains == "robust") {
      note_unsettled(one.scenario, one.mode, one.completed_share, findings);
    }
  }
  return findings;
}

}  // namespace awmr::cli
