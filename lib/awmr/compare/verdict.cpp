#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/compare/binomial.h"
#include "awmr/compare/ranking.h"

namespace awmr {
namespace {

/// "a, b and c"
std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

/// The ranked metric in which `other` is furthest behind `best`, of those that are told apart.
const PairedDifference* widest_gap(const ScenarioRows& scenario,
                                   const std::vector<PairedDifference>& differences,
                                   const Contender& best, const Contender& other) {
  const PairedDifference* widest = nullptr;
  double widest_share = 0.0;
  for (const PairedDifference& d : differences) {
    const MetricColumn& metric = column_of(d.metric);
    if (!d.is_between(best, other) || !d.mean || !metric.ranked()) continue;
    if (d.p_holm && *d.p_holm >= kSignificance) continue;
    const double behind = (d.first == best ? -*d.mean : *d.mean) / ranking_scale(scenario, metric);
    if (behind > widest_share) {
      widest = &d;
      widest_share = behind;
    }
  }
  return widest;
}

/// ", most of all in finish_time_s: 8.2 s more (95 %: 8 to 8.4)"
std::string gap_text(const PairedDifference* gap, const Contender& other) {
  if (gap == nullptr) return "";
  // Where `other` comes second, first minus second is below 0.
  const double sign = gap->second == other ? -1.0 : 1.0;
  const MetricColumn& metric = column_of(gap->metric);
  std::string text = fmt::format(", most of all in {}: {:.3g} {} more", metric.name,
                                 sign * *gap->mean, metric.unit);
  if (gap->ci95) {
    const double a = sign * gap->ci95->lo;
    const double b = sign * gap->ci95->hi;
    text += fmt::format(" (95 %: {:.3g} to {:.3g})", std::min(a, b), std::max(a, b));
  }
  return text;
}

/// "steering completed 10 of 20 (95 %: 27 to 73 %)", or "all completed".
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
  return text.empty() ? "all completed" : text;
}

}  // namespace

std::string verdict_of(const ScenarioRows& scenario, const std::vector<RankedMode>& ranking,
                       const std::vector<PairedDifference>& differences) {
  if (ranking.empty()) return "not ranked: the scenario gives the vehicle nothing to follow.";
  const RankedMode& best = ranking.front();
  std::string text;
  if (best.completed_share <= 0.0) {
    text = "none completed; by score ";
  }
  std::vector<std::string> first{best.contender.label()};
  first.insert(first.end(), best.tied_with.begin(), best.tied_with.end());
  if (first.size() == ranking.size() && first.size() > 1) {
    text += joined(first) + " tie: these runs do not tell them apart";
  } else {
    text += joined(first) + (first.size() > 1 ? " tie for the first place" : " is best");
    for (const RankedMode& other : ranking) {
      if (other.rank == 1) continue;
      const PairedDifference* gap =
          widest_gap(scenario, differences, best.contender, other.contender);
      text +=
          fmt::format("; {} is behind{}", other.contender.label(), gap_text(gap, other.contender));
    }
  }
  text += "; " + completion_text(scenario);
  if (scenario.modes.front().rows.size() < 3) {
    text += "; the nominal run alone, without samples, shows no spread";
  }
  return text + ".";
}

}  // namespace awmr
