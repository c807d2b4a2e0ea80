#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "awmr/compare/decision.h"
#include "awmr/compare/scoring.h"
#include "awmr/core/containers.h"
#include "awmr/core/statistics/binomial.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

/// Finds the metric in which `other` is furthest behind `best`, measured in multiples of the
/// metric's relevance margin. Only metrics with a weight are considered. Null if no difference is
/// relevant.
const PairedDifference* widest_gap(const std::vector<PairedDifference>& differences,
                                   const Preferences& preferences, const Contender& best,
                                   const Contender& other) {
  const PairedDifference* widest = nullptr;
  double widest_margins = 0.0;
  for (const PairedDifference& d : differences) {
    if (!d.is_between(best, other) || d.conclusion != Conclusion::kRelevant) continue;
    if (!(weight_of(*d.metric, preferences) > 0.0)) continue;
    const double behind = (d.first == best ? -*d.mean : *d.mean) / d.margin;
    if (behind > widest_margins) {
      widest = &d;
      widest_margins = behind;
    }
  }
  return widest;
}

/// Text of the metric in which `other` is furthest behind the best mode: ", most of all in
/// finish_time_s: 8.2 s more (95 %: 8 to 8.4)". Empty without such a metric.
std::string gap_text(const PairedDifference* gap, const Contender& other) {
  if (gap == nullptr) return "";
  // The difference is first minus second. The text states how much larger the metric of `other` is,
  // so the sign changes if `other` is the second contender.
  const double sign = gap->second == other ? -1.0 : 1.0;
  const MetricColumn& metric = *gap->metric;
  std::string text = fmt::format(", most of all in {}: {:.3g} {} more", metric.name,
                                 sign * *gap->mean, metric.unit);
  if (gap->ci95) {
    const double a = sign * gap->ci95->lo;
    const double b = sign * gap->ci95->hi;
    text += fmt::format(" (95 %: {:.3g} to {:.3g})", std::min(a, b), std::max(a, b));
  }
  return text;
}

/// Text of the completed runs: "steering completed 10 of 20 (95 %: 27 to 73 %)", or "all
/// completed".
std::string completion_text(const ScenarioRows& scenario) {
  std::string text;
  for (const ModeRows& rows : scenario.modes) {
    const std::size_t runs = rows.counted().size();
    if (rows.completed_count() == runs) continue;
    const Interval share = clopper_pearson(rows.completed_count(), runs);
    text += fmt::format("{}{} completed {} of {}", text.empty() ? "" : ", ", rows.label(),
                        rows.completed_count(), runs);
    if (runs >= 2) {
      text += fmt::format(" (95 %: {:.0f} to {:.0f} %)", 100.0 * share.lo, 100.0 * share.hi);
    }
  }
  return text.empty() ? "all completed" : text + "; scores include runs that were not completed";
}

/// Text of how far the score is behind that of the best mode: " by 31 % (95 %: 28 to 35 %)".
std::string share_text(const RankedMode& other) {
  if (!(other.score > 1.0)) return "";
  const auto percent = [](double ratio) { return 100.0 * (ratio - 1.0); };
  std::string text = fmt::format(" by {:.3g} %", percent(other.score));
  if (other.behind_ci95) {
    text += fmt::format(" (95 %: {:.3g} to {:.3g} %)", percent(other.behind_ci95->lo),
                        percent(other.behind_ci95->hi));
  }
  return text;
}

/// Text of what a tie means: "combined is equivalent within 5 %, steering is undecided, behind by
/// 3.4 % (95 %: 1 to 5.6 %)". If all tied modes are equivalent: "equivalent within 5 %".
std::string tie_text(const std::vector<RankedMode>& ranking, const Preferences& preferences) {
  const std::string within = fmt::format("equivalent within {:g} %", 100.0 * preferences.relevance);
  std::vector<std::string> parts;
  bool all_equivalent = true;
  for (std::size_t i = 1; i < ranking.size() && ranking[i].rank == 1; ++i) {
    const RankedMode& mode = ranking[i];
    const bool is_equivalent = mode.towards_leader == Conclusion::kEquivalent;
    all_equivalent = all_equivalent && is_equivalent;
    const std::string behind = share_text(mode);
    parts.push_back(fmt::format("{} is {}", mode.contender.label(),
                                is_equivalent    ? within
                                : behind.empty() ? "undecided"
                                                 : "undecided, behind" + behind));
  }
  return all_equivalent ? within : fmt::format("{}", fmt::join(parts, ", "));
}

/// Text of the modes of rank 1: "combined is best", "combined and steering are tied for best:
/// equivalent within 5 %".
std::string first_text(const std::vector<RankedMode>& ranking, bool is_undecided,
                       const Preferences& preferences) {
  const RankedMode& best = ranking.front();
  if (ranking.size() == 1) return best.contender.label() + " is the only one compared";
  std::vector<std::string> first{best.contender.label()};
  append(first, best.tied_with);
  if (first.size() == 1) return first.front() + (is_undecided ? " is ahead here" : " is best");
  return fmt::format("{} are tied{}: {}", enumerated(first, std::identity(), " and "),
                     first.size() < ranking.size() ? " for best" : "",
                     tie_text(ranking, preferences));
}

/// Text of the metrics in which modes that are tied for rank 1 differ relevantly: "; relevant
/// single metrics: steering 0.43 m more cross_track_rms_m than combined". For each mode, it names
/// only the metrics in which the mode is furthest behind and furthest ahead of the first mode.
std::string tied_gaps_text(const std::vector<RankedMode>& ranking,
                           const std::vector<PairedDifference>& differences,
                           const Preferences& preferences) {
  std::vector<std::string> gaps;
  const Contender& best = ranking.front().contender;
  const auto add = [&](const Contender& ahead, const Contender& behind) {
    const PairedDifference* gap = widest_gap(differences, preferences, ahead, behind);
    if (gap == nullptr) return;
    const MetricColumn& metric = *gap->metric;
    gaps.push_back(fmt::format("{} {:.3g} {} more {} than {}", behind.label(), std::abs(*gap->mean),
                               metric.unit, metric.name, ahead.label()));
  };
  for (std::size_t i = 1; i < ranking.size() && ranking[i].rank == 1; ++i) {
    add(best, ranking[i].contender);
    add(ranking[i].contender, best);
  }
  if (gaps.empty()) return {};
  return fmt::format("; relevant single metrics: {}", fmt::join(gaps, ", "));
}

/// Text of the robustness of rank 1: "; combined is best for 83 % of all metric weightings and in
/// 97 % of the samples".
std::string stability_text(const RankedMode& best) {
  if (!best.tied_with.empty()) return {};  // no mode has rank 1 alone
  std::string text = fmt::format("; {} is best for {:.0f} % of all metric weightings",
                                 best.contender.label(), 100.0 * best.first_by_weights);
  if (best.first_by_samples) {
    text += fmt::format(" and in {:.0f} % of the samples", 100.0 * *best.first_by_samples);
  }
  return text;
}

/// Joins the names of modes: "differential and combined"; "none" for an empty list.
std::string listed(const std::vector<Contender>& contenders) {
  std::vector<std::string> labels;
  for (const Contender& one : contenders) labels.push_back(one.label());
  return labels.empty() ? "none" : fmt::format("{}", fmt::join(labels, " and "));
}

/// Text such as "; differential completed 0 of 1 on the four-wheel plant": names the modes that
/// complete no run under a change.
std::string incomplete_in_words(const std::vector<Change>& changes) {
  std::string text;
  for (const Change& change : changes) {
    std::vector<std::string> labels;
    std::size_t runs = 0;
    for (const Completion& one : change.completed) {
      if (one.count > 0) continue;
      labels.push_back(one.contender.label());
      runs = one.of;
    }
    if (labels.empty()) continue;
    text +=
        fmt::format("; {} completed 0 of {} {}", fmt::join(labels, " and "), runs, text_of(change));
  }
  return text;
}

std::string trials_in_words(const std::vector<std::string_view>& trials) {
  if (trials.empty()) return {};
  return fmt::format("; {} would show which plant is right (awmr suggest)",
                     fmt::join(trials, " and "));
}

/// Text of a lead by one metric alone; empty without such a lead.
std::string narrow_text(const Decision& decision) {
  if (!decision.narrow_lead) return {};
  return fmt::format(
      "; undecided: {} leads {} only by {}, and no longer if this metric has half of its weight",
      listed(decision.first), listed(decision.narrow_lead->others),
      decision.narrow_lead->metric->name);
}

/// End of a verdict: "; undecided: ...", or "; combined keeps a first place ...", then modes that
/// complete no run under a change, and trials that would show which plant is right.
std::string decision_text(const Decision& decision) {
  const std::vector<Contender> never_behind = decision.never_behind();
  const bool is_undecided = never_behind.empty();
  std::vector<std::string> words;
  for (const Change& change : decision.changes) {
    if (!is_undecided) {
      words.push_back(text_of(change));
    } else if (!std::ranges::is_permutation(change.first, decision.first)) {
      words.push_back(fmt::format("{} first {}", listed(change.first), text_of(change)));
    }
  }
  const bool differ = decision.kind() != DecisionKind::kDecided;
  const std::string trials = differ ? trials_in_words(decision.deciding_trials()) : "";
  const std::string incomplete = incomplete_in_words(decision.changes) + narrow_text(decision);
  if (is_undecided) {
    return fmt::format("; undecided{}{}{}{}", words.empty() ? "" : ": ", fmt::join(words, ", "),
                       incomplete, trials);
  }
  const bool is_preferred = never_behind.size() == 1 && decision.first.size() > 1;
  return fmt::format(
      "; {} a first place {}{}{}",
      is_preferred ? fmt::format("{0} is preferred, because only {0} keeps", listed(never_behind))
                   : listed(never_behind) + (never_behind.size() == 1 ? " keeps" : " keep"),
      fmt::join(words, ", "), incomplete, trials);
}

}  // namespace

std::string text_of(const Change& change) {
  switch (change.kind) {
    case ChangeKind::kPlant:
      return fmt::format("on the {} plant", change.setting);
    case ChangeKind::kWeights:
      return fmt::format("with all weights {}", change.setting);
    case ChangeKind::kGains:
      return fmt::format("with gains {:.1f} times {}", kGainsFactor, change.setting);
  }
  return {};
}

std::string verdict_of(const ScenarioRows& scenario, const std::vector<RankedMode>& ranking,
                       const std::optional<Decision>& decision,
                       const std::vector<PairedDifference>& differences,
                       const Preferences& preferences) {
  if (ranking.empty()) return std::string(kNotRanked) + ".";
  const bool is_undecided = decision && decision->kind() == DecisionKind::kUndecided;
  const RankedMode& best = ranking.front();
  const bool any_completed = std::ranges::any_of(
      ranking, [](const RankedMode& mode) { return mode.completed_share > 0.0; });
  std::string text = best.completed_share > 0.0 ? ""
                     : any_completed            ? "by score "
                                                : "none completed; by score ";
  text += first_text(ranking, is_undecided, preferences);
  for (const RankedMode& other : ranking) {
    if (other.rank == 1) continue;
    const PairedDifference* gap =
        widest_gap(differences, preferences, best.contender, other.contender);
    text += fmt::format("; {} is behind{}{}", other.contender.label(), share_text(other),
                        gap_text(gap, other.contender));
  }
  text += tied_gaps_text(ranking, differences, preferences);
  text += "; " + completion_text(scenario);
  if (ranking.size() > 1) text += stability_text(best);
  if (decision) text += decision_text(*decision);
  const std::size_t samples = scenario.modes.front().rows.size() - 1;
  if (samples < 2) {
    text += samples == 0 ? "; nominal model only, no uncertainty (give --samples)"
                         : "; one sample gives no uncertainty (increase --samples)";
  }
  return text + ".";
}

}  // namespace awmr
