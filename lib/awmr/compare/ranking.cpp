#include "awmr/compare/ranking.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "awmr/compare/scoring.h"
#include "awmr/core/random.h"
#include "awmr/core/statistics/binomial.h"
#include "awmr/core/statistics/sample_quantile.h"

namespace awmr {
namespace {

/// Random stream for the weightings of the metrics. To be independent, it must differ from the
/// streams of the samples and of the bootstrap (statistics.cpp).
constexpr std::uint64_t kWeightStream = std::uint64_t{5} << 61U;
/// Number of random weightings. A larger number makes the shares more exact.
constexpr int kWeightings = 1000;

/// A mode to be ranked, with the logarithms from which its score is computed.
struct RankingEntry {
  std::size_t mode = 0;  ///< index in ScenarioRows::modes
  const ModeRows* rows = nullptr;
  /// log_score() of each run in the statistics (ModeRows::counted).
  std::vector<double> log_scores;
  std::vector<double> mean_losses;  ///< for each scored metric, mean log_loss() over the same runs
  /// False if the mode completes significantly fewer runs than the mode with the most completed
  /// runs, or no run although another mode completes some.
  bool completes = true;

  double log_score() const { return mean_of(log_scores); }
};

RankingEntry entry_of(const ScenarioRows& scenario, std::size_t mode,
                      const std::vector<ScoredMetric>& scoring) {
  const ModeRows& rows = scenario.modes[mode];
  RankingEntry entry{
      .mode = mode, .rows = &rows, .log_scores = log_scores(rows, scoring), .mean_losses = {}};
  for (const ScoredMetric& scored : scoring) {
    entry.mean_losses.push_back(mean_log_loss(rows, scored));
  }
  return entry;
}

/// Order of modes with equal scores: by mode, then by name of the gains, so that the order in which
/// the user gives the gains does not matter.
bool is_before(const ModeRows& a, const ModeRows& b) {
  return std::tie(a.contender.mode, a.contender.gains) <
         std::tie(b.contender.mode, b.contender.gains);
}

/// True if two modes complete the scenario about equally often: the exact McNemar test, which
/// compares the runs sample by sample, finds no significant difference. False if only one mode
/// completes any run.
bool complete_alike(const ModeRows& a, const ModeRows& b) {
  if ((a.completed_count() == 0) != (b.completed_count() == 0)) return false;
  const auto first = a.counted();
  const auto second = b.counted();
  std::size_t only_first = 0;
  std::size_t only_second = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i].metrics.completed && !second[i].metrics.completed) ++only_first;
    if (second[i].metrics.completed && !first[i].metrics.completed) ++only_second;
  }
  return mcnemar_p(only_first, only_second) >= kSignificance;
}

/// Returns the modes of a scenario, best first. Modes that complete often enough
/// (RankingEntry::completes) come first, sorted by score; the other modes follow, sorted by number
/// of completed runs.
std::vector<RankingEntry> sorted_entries(const ScenarioRows& scenario,
                                         const std::vector<ScoredMetric>& scoring) {
  std::vector<RankingEntry> entries;
  for (std::size_t mode = 0; mode < scenario.modes.size(); ++mode) {
    entries.push_back(entry_of(scenario, mode, scoring));
  }
  const auto most = std::max_element(
      scenario.modes.begin(), scenario.modes.end(), [](const ModeRows& a, const ModeRows& b) {
        const std::size_t first = a.completed_count();
        const std::size_t second = b.completed_count();
        return first < second || (first == second && is_before(b, a));
      });
  for (RankingEntry& entry : entries) entry.completes = complete_alike(*entry.rows, *most);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const RankingEntry& a, const RankingEntry& b) {
                     if (a.completes != b.completes) return a.completes;
                     if (!a.completes && a.rows->completed_count() != b.rows->completed_count()) {
                       return a.rows->completed_count() > b.rows->completed_count();
                     }
                     const double first = a.log_score();
                     const double second = b.log_score();
                     return first < second || (!(second < first) && is_before(*a.rows, *b.rows));
                   });
  return entries;
}

/// Returns the difference of the mean log scores of two modes, `own` minus `leader`, in each
/// bootstrap resample, sorted ascending:
///   sum over the scored metrics k of w_k (mean loss of own - mean loss of leader)
std::vector<double> resampled_differences(const RankingEntry& own, const RankingEntry& leader,
                                          const std::vector<ScoredMetric>& scoring,
                                          const ScenarioStatistics& statistics) {
  std::vector<double> means(kResamples, 0.0);
  for (const ScoredMetric& scored : scoring) {
    const auto& of_own = statistics.resampled_losses[loss_row(own.mode, *scored.metric)];
    const auto& of_leader = statistics.resampled_losses[loss_row(leader.mode, *scored.metric)];
    for (std::size_t i = 0; i < means.size(); ++i) {
      means[i] += scored.weight * (of_own[i] - of_leader[i]);
    }
  }
  std::sort(means.begin(), means.end());
  return means;
}

/// Comparison of a mode's score with the leader's.
struct Behind {
  std::optional<Interval> ratio_ci95;  ///< 95 % interval of the ratio; absent below 2 samples
  Conclusion conclusion{};
};

Behind behind(const RankingEntry& own, const RankingEntry& leader, double relevance,
              const std::vector<ScoredMetric>& scoring, const ScenarioStatistics& statistics) {
  const double margin = std::log1p(relevance);
  if (own.log_scores.size() < 2) {
    const bool beyond = own.log_score() - leader.log_score() > margin;
    return {{}, beyond ? Conclusion::kRelevant : Conclusion::kEquivalent};
  }
  const std::vector<double> means = resampled_differences(own, leader, scoring, statistics);
  const double tail = bootstrap_tail(own.log_scores.size(), 0.025);
  const Interval ci95{quantile_of_sorted(means, tail), quantile_of_sorted(means, 1.0 - tail)};
  const Interval ratio{std::exp(ci95.lo), std::exp(ci95.hi)};
  if (ci95.lo > margin) return {ratio, Conclusion::kRelevant};
  const double one_sided = bootstrap_tail(own.log_scores.size(), 0.05);
  const bool within = quantile_of_sorted(means, one_sided) >= -margin &&
                      quantile_of_sorted(means, 1.0 - one_sided) <= margin;
  return {ratio, within ? Conclusion::kEquivalent : Conclusion::kUndecided};
}

/// Divides a count of 1 equally among the best entries, whose value is within `margin` of the
/// smallest value. Entries that complete too few runs (RankingEntry::completes) are ignored.
template <class Value>
void count_best(const std::vector<RankingEntry>& entries, double margin, Value&& value,
                std::vector<double>& counts) {
  constexpr double kRounding = 1e-12;
  // The first entry always has `completes` set.
  double least = value(entries.front());
  for (const RankingEntry& entry : entries) {
    if (entry.completes) least = std::min(least, value(entry));
  }
  const double most = least + margin + kRounding * (1.0 + std::abs(least));
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].completes && value(entries[i]) <= most) best.push_back(i);
  }
  for (const std::size_t i : best) counts[i] += 1.0 / static_cast<double>(best.size());
}

/// Returns for each entry the share of random weightings of the metrics with which it is best. The
/// weightings are uniformly distributed over all weightings that sum to 1.
std::vector<double> shares_by_weights(const std::vector<RankingEntry>& entries, double margin,
                                      Random random) {
  std::vector<double> shares(entries.size(), 0.0);
  std::vector<double> weights(entries.front().mean_losses.size());
  for (int draw = 0; draw < kWeightings; ++draw) {
    for (double& weight : weights) weight = -std::log1p(-random.uniform());  // Dirichlet(1, ..., 1)
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    const auto loss = [&](const RankingEntry& entry) {
      return std::inner_product(weights.begin(), weights.end(), entry.mean_losses.begin(), 0.0);
    };
    count_best(entries, margin, loss, shares);
  }
  for (double& share : shares) share /= kWeightings;
  return shares;
}

std::vector<double> shares_by_samples(const std::vector<RankingEntry>& entries, double margin) {
  const std::size_t n = entries.front().log_scores.size();
  std::vector<double> shares(entries.size(), 0.0);
  for (std::size_t sample = 0; sample < n; ++sample) {
    count_best(
        entries, margin, [&](const RankingEntry& entry) { return entry.log_scores[sample]; },
        shares);
  }
  for (double& share : shares) share /= static_cast<double>(n);
  return shares;
}

bool is_scored(const MetricColumn* metric, const std::vector<ScoredMetric>& scoring) {
  return std::any_of(scoring.begin(), scoring.end(),
                     [&](const ScoredMetric& scored) { return scored.metric == metric; });
}

/// True if two modes are equivalent in every scored metric that both have. Then even a significant
/// difference of their scores does not matter.
bool equivalent_in_all(const Contender& a, const Contender& b,
                       const std::vector<ScoredMetric>& scoring,
                       const std::vector<PairedDifference>& differences) {
  bool any = false;
  for (const PairedDifference& d : differences) {
    if (!is_scored(d.metric, scoring) || !d.is_between(a, b) || !d.mean) continue;
    if (d.conclusion != Conclusion::kEquivalent) return false;
    any = true;
  }
  return any;
}

/// True if `other` is relevantly better than `own` in a scored metric and relevantly worse in none.
bool dominates(const Contender& other, const Contender& own,
               const std::vector<ScoredMetric>& scoring,
               const std::vector<PairedDifference>& differences) {
  bool better = false;
  for (const PairedDifference& d : differences) {
    if (!is_scored(d.metric, scoring) || !d.is_between(own, other) ||
        d.conclusion != Conclusion::kRelevant) {
      continue;
    }
    const bool first_is_worse = *d.mean > 0.0;
    if (first_is_worse != (d.first == own)) return false;
    better = true;
  }
  return better;
}

/// Returns a mode with the fields that do not depend on its rank. `best`: first entry in the list.
RankedMode unranked_mode(const RankingEntry& own, const RankingEntry& best, double by_weights,
                         double by_samples) {
  RankedMode mode;
  mode.contender = own.rows->contender;
  mode.score = std::exp(own.log_score() - best.log_score());
  mode.completed_share = own.rows->completed_share();
  mode.first_by_weights = by_weights;
  if (own.log_scores.size() >= 2) mode.first_by_samples = by_samples;
  return mode;
}

/// If several modes are tied for rank 1, replaces their first_by_weights by the mean over these
/// modes, because no mode is best alone. Does the same with first_by_samples if the modes are
/// equivalent.
void share_firsts_of_ties(std::vector<RankedMode>& ranking) {
  const auto end = std::find_if(ranking.begin(), ranking.end(),
                                [](const RankedMode& mode) { return mode.rank > 1; });
  const auto count = static_cast<double>(end - ranking.begin());
  const bool equal = std::all_of(
      ranking.begin() + 1, std::max(end, ranking.begin() + 1),
      [](const RankedMode& mode) { return mode.towards_leader == Conclusion::kEquivalent; });
  double weights = 0.0;
  double samples = 0.0;
  for (auto mode = ranking.begin(); mode != end; ++mode) {
    weights += mode->first_by_weights / count;
    samples += mode->first_by_samples.value_or(0.0) / count;
  }
  for (auto mode = ranking.begin(); mode != end; ++mode) {
    mode->first_by_weights = weights;
    if (equal && mode->first_by_samples) mode->first_by_samples = samples;
  }
}

void name_ties_and_dominance(std::vector<RankedMode>& ranking,
                             const std::vector<ScoredMetric>& scoring,
                             const std::vector<PairedDifference>& differences) {
  for (RankedMode& mode : ranking) {
    for (const RankedMode& other : ranking) {
      if (other.contender == mode.contender) continue;
      if (other.rank == mode.rank) mode.tied_with.push_back(other.contender.label());
      if (dominates(other.contender, mode.contender, scoring, differences)) {
        mode.dominated_by.push_back(other.contender.label());
      }
    }
  }
}

}  // namespace

bool has_a_goal(const ScenarioRows& scenario) {
  return std::any_of(scenario.modes.begin(), scenario.modes.end(), [](const ModeRows& rows) {
    const Metrics& m = rows.nominal();
    return m.heading_iae_degs || m.cross_track_rms_m || m.finish_time_s;
  });
}

std::vector<RankedMode> rank(const ScenarioRows& scenario, const ScenarioStatistics& statistics,
                             const Preferences& preferences, std::uint64_t seed) {
  const std::vector<ScoredMetric> scoring = scoring_of(scenario, preferences);
  if (!has_a_goal(scenario) || scoring.empty()) return {};
  const std::vector<RankingEntry> entries = sorted_entries(scenario, scoring);
  const double margin = std::log1p(preferences.relevance);
  const std::vector<double> by_weights =
      shares_by_weights(entries, margin, Random(seed, kWeightStream));
  const std::vector<double> by_samples = shares_by_samples(entries, margin);
  const auto behind_entry = [&](const RankingEntry& own, const RankingEntry& other) {
    return behind(own, other, preferences.relevance, scoring, statistics);
  };
  std::vector<RankedMode> ranking;
  std::size_t leader = 0;  // index of the best entry of the current rank
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const RankingEntry& own = entries[i];
    RankedMode ranked = unranked_mode(own, entries.front(), by_weights[i], by_samples[i]);
    if (i > 0) {
      const RankingEntry& ahead = entries[leader];
      const Behind first = behind_entry(own, entries.front());
      const bool alike = complete_alike(*own.rows, *ahead.rows);
      const bool equal = equivalent_in_all(own.rows->contender, ahead.rows->contender, scoring,
                                           statistics.differences);
      ranked.behind_ci95 = first.ratio_ci95;
      ranked.towards_leader = !alike        ? Conclusion::kRelevant
                              : equal       ? Conclusion::kEquivalent
                              : leader == 0 ? first.conclusion
                                            : behind_entry(own, ahead).conclusion;
      if (ranked.towards_leader == Conclusion::kRelevant) leader = i;
    }
    ranked.rank = static_cast<int>(leader) + 1;
    ranking.push_back(std::move(ranked));
  }
  share_firsts_of_ties(ranking);
  name_ties_and_dominance(ranking, scoring, statistics.differences);
  return ranking;
}

}  // namespace awmr
