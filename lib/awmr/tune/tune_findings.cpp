#include "awmr/tune/tune_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <optional>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/validity.h"
#include "awmr/tune/steering_rate.h"
#include "awmr/tune/unsettled_text.h"

namespace awmr {
namespace {

void note_goal(const EvaluatedGoal& evaluated, std::vector<Finding>& findings) {
  if (evaluated.verdict == GoalVerdict::kMet) return;
  const bool is_missed = evaluated.verdict == GoalVerdict::kMissed;
  findings.push_back(
      {"", 0, Severity::kWarning, is_missed ? "goal-missed" : "goal-open",
       fmt::format(
           "{} of {} newly drawn vehicles in {} mode meet the goal (95 % interval of their share: "
           "{:.1f} to {:.1f} %); {:g} % are required: {}",
           evaluated.held, evaluated.runs, name_of(evaluated.mode), 100.0 * evaluated.ci95.lo,
           100.0 * evaluated.ci95.hi, 100.0 * evaluated.goal.share,
           is_missed ? "tune on more draws (" + option_text("draws") +
                           "), raise the goal's limits or lower its share"
                     : std::string("increase judged_draws"))});
}

void note_certificate(const ModeCertificate& certificate, std::vector<Finding>& findings) {
  if (certificate.damping.value > 0.0) return;
  std::string where;
  for (const auto& [id, value] : certificate.damping.parameters) {
    where += fmt::format("{}{} = {:.4g}", where.empty() ? "" : ", ", info(id).name, value);
  }
  findings.push_back(
      {"", 0, Severity::kWarning, "not-certified",
       fmt::format("{}: the heading loop is unstable for parameters within the model's 95 % "
                   "confidence set (damping ratio {:.3g} at {}, yaw rate {:.3g} deg/s). Record the "
                   "trials that `awmr suggest` names, or raise limits/late_damping of tune.json",
                   name_of(certificate.mode), certificate.damping.value, where,
                   degrees(certificate.damping.yaw_rate_radps))});
}

void note_observer(const Tuning& tuning, std::vector<Finding>& findings) {
  std::string bandwidths;
  const auto add = [&bandwidths](const Tuning& one) {
    if (!one.observer_added) return;
    bandwidths += fmt::format("{}{:.3g} rad/s{}", bandwidths.empty() ? "" : ", ",
                              one.gains.observer.bandwidth_radps,
                              one.mode ? fmt::format(" in {} mode", name_of(*one.mode)) : "");
  };
  for (const Tuning& one : tuning.own) add(one);
  add(tuning);
  if (bandwidths.empty()) return;
  findings.push_back(
      {"", 0, Severity::kWarning, "observer-added",
       fmt::format("fewer than {:g} % of the runs settle without a disturbance observer, which "
                   "compensates constant forces such as dry friction. An observer was therefore "
                   "tuned, which the firmware runs (bandwidth: {}). To tune without an observer: "
                   "{}",
                   100.0 * kSettledShare, bandwidths, option_text("no_observer"))});
}

void note_pushes(const TuneOptions& options, std::vector<Finding>& findings) {
  const bool is_pushed = std::ranges::any_of(
      options.scenarios, [](const Scenario& scenario) { return scenario.disturbance.any(); });
  if (!options.observer || is_pushed) return;
  findings.push_back(
      {"", 0, Severity::kWarning, "observer-unpushed",
       "no scenario has a disturbance, so the search did not test how the observer rejects it. "
       "Give a scenario with a `disturbance`, or give no scenarios to use the default scenarios"});
}

void note_baseline(const Tuning& tuning, std::vector<Finding>& findings) {
  if (tuning.baseline_violates.empty() || tuning.objective <= tuning.baseline_objective) return;
  std::string limits;
  for (const ConstraintReport& c : tuning.baseline_violates) {
    limits += fmt::format("{}{} {:.4g} ({} {:.4g})", limits.empty() ? "" : ", ", c.name, c.value,
                          c.sense == Sense::kAtMost ? "at most" : "at least", c.limit);
  }
  findings.push_back(
      {"", 0, Severity::kNote, "baseline-beyond-limits",
       fmt::format("the objective of the tuned gains ({:.4g}) is above that of the baseline {} "
                   "({:.4g}), because the baseline violates limits: {}. Relax these limits, or "
                   "give a baseline that meets them ({})",
                   tuning.objective, tuning.baseline.source, tuning.baseline_objective, limits,
                   option_text("baseline"))});
}

/// True if the paper's gains settle in at least kSettledShare of the runs in the mode and scenario
/// of `baseline`.
bool paper_settles(const std::vector<EvaluatedGains>& all, const EvaluatedGains& baseline) {
  return std::ranges::any_of(all, [&](const EvaluatedGains& one) {
    return one.gains == "paper" && one.mode == baseline.mode && one.scenario == baseline.scenario &&
           one.completed_share >= kSettledShare;
  });
}

/// The objective divides by the metrics of the baseline. Adds the note `baseline-unsettled` if no
/// run of a scenario and mode settles with the baseline.
void note_unsettled_baseline(const Tuning& tuning, std::vector<Finding>& findings) {
  if (!tuning.robust) return;
  const RobustTuning& robust = *tuning.robust;
  const auto& all =
      robust.evaluated_by_scenario.empty() ? robust.evaluated : robust.evaluated_by_scenario;
  std::string where;
  bool settles_with_paper = true;
  for (const EvaluatedGains& one : all) {
    if (one.gains != "baseline" || one.completed_share > 0.0) continue;
    where += (where.empty() ? "" : "; ") + run_name(one.scenario, one.mode);
    settles_with_paper = settles_with_paper && paper_settles(all, one);
  }
  if (where.empty()) return;
  findings.push_back(
      {"", 0, Severity::kNote, "baseline-unsettled",
       fmt::format("with the baseline gains ({}), no run settles ({}). The objective ({:.4g}) is "
                   "relative to the baseline, so it does not show how good the tuned gains are. "
                   "Compare the settling times in /robust, or give gains that settle as the "
                   "baseline: {}",
                   tuning.baseline.source, where, tuning.objective,
                   option_text(settles_with_paper ? "baseline paper" : "baseline FILE"))});
}

void note_modes(const Tuning& tuning, std::vector<Finding>& findings) {
  if (!tuning.own.empty()) {
    findings.push_back({"", 0, Severity::kNote, "gains-by-mode",
                        fmt::format("modes have their own gains, because some modes settle more "
                                    "slowly than necessary with one set for all modes. simulate, "
                                    "compare, pil and the firmware use the gains of the "
                                    "selected mode. For one set: {}",
                                    option_text("one_set"))});
  }
  std::string modes;
  const auto add = [&modes](const Tuning& tuned) {
    for (const ModeAlone& one : tuned.alone) {
      modes += fmt::format("{}{}: {:.2g} s in place of {:.2g} s", modes.empty() ? "" : "; ",
                           name_of(one.mode), one.settling_time_s, one.tuned_settling_time_s);
    }
  };
  for (const Tuning& one : tuning.own) add(one);
  add(tuning);
  if (modes.empty()) return;
  findings.push_back(
      {"", 0, Severity::kNote, "faster-in-one-mode",
       fmt::format(
           "gains for one mode alone, by pole placement, settle faster than the tuned gains "
           "(mean settling time: {}). If the vehicle uses only one mode, tune for this mode "
           "({})",
           modes, option_text("mode MODE"))});
}

/// Adds the findings of unattainable_requests() for the scenarios and for the sensor and motor
/// conditions of the drawn vehicles.
void note_scenarios(const Model& model, const TuneOptions& options, const Tuning& tuning,
                    std::vector<Finding>& findings) {
  std::vector<Scenario> scenarios = options.scenarios;
  if (tuning.robust) {
    scenarios.push_back(
        under(tuning.robust->conditions, {.name = "the vehicle", .guidance = OpenLoop{}}));
  }
  for (const Scenario& scenario : scenarios) {
    std::ranges::move(unattainable_requests(scenario, model), std::back_inserter(findings));
  }
}

/// Findings about one search: of one mode or of all modes. The first are warnings about goals that
/// the newly drawn vehicles do not confirm.
std::vector<Finding> search_findings(const Model& model, const TuneOptions& options,
                                     const Tuning& tuning) {
  std::vector<Finding> findings;
  if (tuning.robust) {
    for (const EvaluatedGoal& goal : tuning.robust->goals) {
      if (goal.gains == kRobustGains) note_goal(goal, findings);
    }
  }
  for (const auto& [text, pointer] : unsettled_texts(tuning.unsettled)) {
    findings.push_back({"", 0, Severity::kWarning, "unsettled", text});
  }
  note_unsettled_baseline(tuning, findings);
  note_baseline(tuning, findings);
  const auto fastest = std::ranges::max_element(
      tuning.scores, {}, [](const ModeScore& score) { return score.metrics.yaw_rate_max_degps; });
  if (fastest != tuning.scores.end()) {
    const auto scenario = std::ranges::find(options.scenarios, fastest->scenario, &Scenario::name);
    assert(scenario != options.scenarios.end());
    auto finding = extrapolation_finding(
        model.file, measured_yaw_rate_degps(model), fastest->metrics.yaw_rate_max_degps,
        fmt::format("{}, {}", fastest->scenario, name_of(fastest->mode)), turn_commands(*scenario));
    if (finding) findings.push_back(*std::move(finding));
  }
  if (const auto plant = model.plant()) {
    auto finding = noise_beyond_servo(model.vehicle, *plant, tuning);
    if (finding) findings.push_back(*std::move(finding));
  }
  return findings;
}

}  // namespace

std::vector<Finding> tune_findings(const Model& model, const TuneOptions& options,
                                   const Tuning& tuning) {
  std::vector<Finding> findings;
  for (const Tuning& one : tuning.own) {
    std::ranges::move(search_findings(model, options, one), std::back_inserter(findings));
  }
  std::ranges::move(search_findings(model, options, tuning), std::back_inserter(findings));
  if (auto finding = missing_intervals(model)) findings.push_back(*std::move(finding));
  for (const ModeCertificate& one : tuning.certificate->modes) note_certificate(one, findings);
  note_observer(tuning, findings);
  note_pushes(options, findings);
  note_modes(tuning, findings);
  if (const auto plant = model.plant()) {
    auto finding = unsigned_speed_finding(*plant, model.vehicle, tuning.mode_gains(), "");
    if (finding) findings.push_back(*std::move(finding));
  }
  note_scenarios(model, options, tuning, findings);
  if (tuning.robust) {
    std::ranges::move(imprecise_parameters(model), std::back_inserter(findings));
  }
  return findings;
}

}  // namespace awmr
