#include "tune_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "awmr/core/text.h"
#include "awmr/tune/relaxation.h"

namespace awmr::cli {
namespace {

std::string gains_line(const char* name, const Gains<double>& gains, double objective) {
  return fmt::format(
      "  {:<14} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4f} {:>8.4f} {:>10.4f}\n", name,
      gains.heading.lambda, gains.heading.mu, gains.heading.epsilon, gains.speed.mu,
      gains.speed.epsilon, gains.heading.sliding_time_constant_s(),
      gains.heading.reaching_time_constant_s(), objective);
}

/// Returns the name of an active constraint, the key of tune.json that sets its limit, and what is
/// limited: "heading damping (limits/damping of tune.json): smallest damping ratio of ...".
std::string described(const std::string& name, const std::vector<ConstraintReport>& constraints) {
  const auto report = std::ranges::find(constraints, name, &ConstraintReport::name);
  if (report == constraints.end()) {  // a limit of the runs
    return name + (name.starts_with("activity, ") ? " (activity_max of tune.json)"
                                                  : " (goals of tune.json)");
  }
  const std::string pointer = pointer_to(name);
  const bool is_fixed = pointer == "/bounds";
  return fmt::format("{} ({}): {}", name,
                     is_fixed ? "fixed limit" : pointer.substr(1) + " of tune.json",
                     report->meaning);
}

/// Describes the active constraints, those of `/search/active` of gains.json. For each, it gives
/// the improvement of the objective by a wider limit, the key that sets the limit, and what is
/// limited. Also gives the ranges of the gains mu and mu_s in which the objective is practically
/// the same.
std::string active_text(const Tuning& tuning) {
  constexpr std::size_t kTextIndent = 12;
  constexpr std::size_t kTextWidth = 98;
  std::string held;
  for (const ActiveConstraint& one : tuning.active) {
    const std::string text = described(one.name, tuning.constraints);
    const std::string percent =
        one.wider_gains < 0.001 ? "< 0.1" : fmt::format("{:.1f}", 100.0 * one.wider_gains);
    held += fmt::format("  {:>6} %  {}\n", percent, wrapped(text, kTextIndent, kTextWidth));
  }
  return fmt::format(
      "  active limits  {}\n{}"
      "  equally good   mu {:.4g} to {:.4g} at the same mu/epsilon, mu_s {:.4g} to {:.4g} at the "
      "same mu_s/eps_s (the smallest are used)\n",
      held.empty() ? "none" : "10 % wider, each would lower the objective by", held,
      tuning.mu_as_good.lo, tuning.mu_as_good.hi, tuning.speed_mu_as_good.lo,
      tuning.speed_mu_as_good.hi);
}

/// Describes the variation of mass and wheel forces for which the gains were tuned in addition to
/// the model's uncertainty; empty if there is none.
std::string open_text(const UnmodelledVariation& open) {
  if (!open.any()) return {};
  std::string text = "  variation     ";
  if (!open.mass_factors.empty()) {
    text += fmt::format(" m' and I'z times {:g}", fmt::join(open.mass_factors, ", "));
  }
  for (const Interval& force : open.wheel_forces) {
    const bool first = &force == &open.wheel_forces.front();
    const char* joint = !first ? "," : open.mass_factors.empty() ? " F'" : "; F'";
    text += fmt::format("{} {:g} to {:g}", joint, force.lo, force.hi);
  }
  return text + '\n';
}

/// Describes the worst case of the heading loop in each mode: the smallest damping ratio and delay
/// margin. The worst case is over the 95 % region of the model's parameters or, without a
/// covariance, over the model's own values.
std::string certificate_text(const Certificate& certificate) {
  std::string by_mode;
  for (const ModeCertificate& one : certificate.modes) {
    by_mode += fmt::format("{}{} {:.3g}, {:.3g} s", by_mode.empty() ? "" : "; ", name_of(one.mode),
                           one.damping.value, one.delay_margin_s.value);
  }
  return fmt::format(
      "  worst case     damping {:.3g}, delay margin {:.3g} s over {}, with {:g} s latency ({})\n",
      certificate.damping_min(), certificate.delay_margin_s(),
      certificate.parameters > 0 ? "the 95 % region of the parameters" : "the model's own values",
      certificate.latency_s, by_mode);
}

/// Returns a note that explains the last column of evaluation_table(), the rate of the steering;
/// empty if the servo never moves.
std::string steering_note(const std::vector<EvaluatedGains>& all) {
  const bool steers = std::ranges::any_of(all, [](const EvaluatedGains& one) {
    return std::ranges::any_of(one.figures, [](const EvaluatedFigure& figure) {
      return figure.name == "steering_rate_rms_degps" && figure.q95 > 0.0;
    });
  });
  if (!steers) return {};
  return "  steer: RMS rate of the steering command in the whole run, turns included. The limit "
         "of\n  "
         "tune.json, limits/steering_rate_rms_degps, applies only to the part caused by noise "
         "while a heading is held\n";
}

/// Returns a table of the metrics of each set of gains. They are computed on fresh draws, that is,
/// newly drawn vehicles that were not used for tuning. If there are several scenarios, the table
/// has a part for each. Empty without fresh draws.
std::string evaluation_table(const std::vector<EvaluatedGains>& all,
                             const std::vector<EvaluatedGains>& by_scenario) {
  if (all.empty()) return {};
  const std::vector<EvaluatedGains>& rows = by_scenario.empty() ? all : by_scenario;
  std::string text =
      fmt::format("  {:<12} {:<10} {:>7} {:>14} {:>10} {:>9} {:>11}\n", "new vehicles", "gains",
                  "settled", "settling s", "overshoot", "IAE deg s", "steer deg/s");
  text += fmt::format("  {:<12} {:<10} {:>7} {:>7} {:>6} {:>10} {:>9} {:>11}\n", "", "", "%",
                      "median", "95 %", "deg, 95 %", "95 %", "95 %");
  std::string_view scenario;
  for (const EvaluatedGains& evaluated : rows) {
    if (evaluated.scenario != scenario) text += fmt::format("  {}\n", evaluated.scenario);
    scenario = evaluated.scenario;
    const auto figure = [&](std::string_view name) {
      return *std::ranges::find(evaluated.figures, name, &EvaluatedFigure::name);
    };
    const EvaluatedFigure settling_s = figure("settling_time_s");
    text += fmt::format("  {:<12} {:<10} {:>7.0f} {:>7.2f} {:>6.2f} {:>10.2f} {:>9.1f} {:>11.1f}\n",
                        name_of(evaluated.mode), evaluated.gains, 100.0 * evaluated.completed_share,
                        settling_s.median, settling_s.q95, figure("overshoot_deg").q95,
                        figure("heading_iae_degs").q95, figure("steering_rate_rms_degps").q95);
  }
  return text + steering_note(rows);
}

/// For each goal, gives the fraction of the fresh draws (vehicles not used for tuning) in which the
/// tuned gains meet it. Empty without goals.
std::string goals_text(const std::vector<EvaluatedGoal>& all) {
  std::string text;
  for (const EvaluatedGoal& evaluated : all) {
    if (evaluated.gains != kRobustGains) continue;
    std::string limits;
    for (const GoalLimit& limit : evaluated.goal.at_most) {
      limits += fmt::format("{}{} <= {:g}", limits.empty() ? "" : ", ", limit.figure, limit.most);
    }
    text += fmt::format(
        "  {:<6} {}, {}{}: {:.1f} % of {} new vehicles (95 %: {:.1f} to {:.1f}), "
        "required {:g} %\n",
        name_in(kGoalVerdictNames, evaluated.verdict), limits, name_of(evaluated.mode),
        evaluated.goal.is_soft ? ", soft" : "", 100.0 * evaluated.held / evaluated.runs,
        evaluated.runs, 100.0 * evaluated.ci95.lo, 100.0 * evaluated.ci95.hi,
        100.0 * evaluated.goal.share);
  }
  return text.empty() ? text : "  goals, on new vehicles\n" + text;
}

/// gains_table() of one search.
std::string table_of(const Tuning& tuning) {
  std::string text =
      fmt::format("  {:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10}\n", "gains", "lambda",
                  "mu", "epsilon", "mu_s", "eps_s", "T1 s", "T2 s", "objective");
  const bool is_known =
      tuning.baseline.source == kPolePlacement || tuning.baseline.source == kPaperSource;
  text += gains_line(is_known ? tuning.baseline.source.c_str() : "baseline",
                     tuning.baseline.gains.common(), tuning.baseline_objective);
  text += gains_line("tuned", tuning.gains, tuning.objective);
  if (const ObserverGains<double>& observer = tuning.gains.observer; observer.is_on()) {
    text += fmt::format(
        "  observer       bandwidth {:.4g} rad/s; compensates a yaw moment up to {:.4g} m and "
        "a surge force up to {:.4g}, both divided by F_max\n",
        observer.bandwidth_radps, observer.yaw_max_m, observer.surge_max);
  }
  return text;
}

/// Text of each search: of all modes, or of one mode after the other with its name as a heading.
template <class Text>
std::string by_search(const Tuning& tuning, const Text& text) {
  if (tuning.own.empty()) return text(tuning);
  std::string all;
  for (const Tuning& one : tuning.own) {
    all += fmt::format("{} mode\n{}", name_of(*one.mode), text(one));
  }
  return all + fmt::format("{} mode\n{}", name_of(*tuning.mode), text(tuning));
}

/// tuning_details() of one search.
std::string details_of(const Tuning& tuning) {
  std::string text = "objective by scenario and mode\n";
  for (const ModeScore& score : tuning.scores) {
    text += fmt::format("  {:<22} {:<13} {:.4f} times the baseline's\n", score.scenario,
                        name_of(score.mode), score.objective);
  }
  text += "constraints\n";
  for (const ConstraintReport& constraint : tuning.constraints) {
    text += fmt::format(
        "  {:<38} {:.4g} {} {:.4g}, margin {:.4g}\n", constraint.name, constraint.value,
        constraint.sense == Sense::kAtMost ? "<=" : ">=", constraint.limit, constraint.margin);
  }
  return text + fmt::format("search\n  {} after {} evaluations: {}\n", tuning.algorithm,
                            tuning.evaluations, tuning.stop_reason);
}

}  // namespace

std::string gains_table(const Tuning& tuning) { return by_search(tuning, table_of); }

std::string tuning_summary(const Tuning& tuning, const TuneOptions& options) {
  return by_search(tuning, [&](const Tuning& one) {
    std::string text = table_of(one) + active_text(one);
    if (&one == &tuning) text += certificate_text(*one.certificate) + open_text(options.open);
    if (one.robust) {
      text += evaluation_table(one.robust->evaluated, one.robust->evaluated_by_scenario) +
              goals_text(one.robust->goals);
    }
    return text;
  });
}

std::string tuning_details(const Tuning& tuning) { return by_search(tuning, details_of); }

}  // namespace awmr::cli
