#include "awmr/compare/ranking.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "awmr/compare/scoring.h"
#include "awmr/core/binomial.h"
#include "awmr/core/index.h"
#include "awmr/core/random.h"
#include "awmr/core/sample_quantile.h"

namespace awmr {
namespace {

/// Random stream of the weightings. It differs from the streams of the samples, and from that of
/// the bootstrap (statistics.cpp).
constexpr std::uint64_t kWeightStream = std::uint64_t{5} << 61U;
constexpr int kWeightings = 1000;

/// A mode to be ranked, with the logarithms from which its score is computed.
struct Entry {
  std::size_t mode = 0;  ///< index in ScenarioRows::modes
  const ModeRows* rows = nullptr;
  /// log_score() of each run in the statistics (ModeRows::counted).
  std::vector<double> log_scores;
  std::vector<double> mean_losses;  ///< for each scored metric, mean log_loss() over the same runs
  /// False: completes significantly less often than the mode that completes most often.
  bool completes = true;

  double log_score() const { return mean(log_scores); }

  static double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
};

Entry entry_of(const ScenarioRows& scenario, std::size_t mode,
               const std::vector<ScoredMetric>& scoring) {
  const ModeRows& rows = scenario.modes[mode];
  Entry entry{
      .mode = mode, .rows = &rows, .log_scores = log_scores(rows, scoring), .mean_losses = {}};
  for (const ScoredMetric& scored : scoring) {
    entry.mean_losses.push_back(mean_log_loss(rows, scored));
  }
  return entry;
}

/// True if two modes complete about equally often: the exact McNemar test finds no significant
/// difference. With a single run, or if one completes all runs and the other none, they must
/// complete equally often.
bool complete_alike(const ModeRows& a, const ModeRows& b) {
  const auto first = a.counted();
  const auto second = b.counted();
  const std::size_t apart = a.completed_count() > b.completed_count()
                                ? a.completed_count() - b.completed_count()
                                : b.completed_count() - a.completed_count();
  if (first.size() < 2 || apart == first.size()) return apart == 0;
  std::size_t only_first = 0;
  std::size_t only_second = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i].metrics.completed && !second[i].metrics.completed) ++only_first;
    if (second[i].metrics.completed && !first[i].metrics.completed) ++only_second;
  }
  return mcnemar_p(only_first, only_second) >= kSignificance;
}

/// Order of modes with equal scores: by mode, then by name of the gains. It does not depend on the
/// order in which the gains are given.
bool is_before(const ModeRows& a, const ModeRows& b) {
  return std::tie(a.contender.mode, a.contender.gains) <
         std::tie(b.contender.mode, b.contender.gains);
}

/// Entries, best first: those that complete (Entry::completes), sorted by score; then the others,
/// sorted by number of completed runs.
std::vector<Entry> sorted_entries(const ScenarioRows& scenario,
                                  const std::vector<ScoredMetric>& scoring) {
  std::vector<Entry> entries;
  for (std::size_t mode = 0; mode < scenario.modes.size(); ++mode) {
    entries.push_back(entry_of(scenario, mode, scoring));
  }
  const auto most = std::max_element(
      scenario.modes.begin(), scenario.modes.end(), [](const ModeRows& a, const ModeRows& b) {
        const std::size_t first = a.completed_count();
        const std::size_t second = b.completed_count();
        return first < second || (first == second && is_before(b, a));
      });
  for (Entry& entry : entries) entry.completes = complete_alike(*entry.rows, *most);
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
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

/// Mean difference of log scores, `own` minus `leader`, in each bootstrap resample, ascending:
///   sum over the scored metrics k of w_k (mean loss of own - mean loss of leader)
std::vector<double> resampled_differences(const Entry& own, const Entry& leader,
                                          const std::vector<ScoredMetric>& scoring,
                                          const ScenarioStatistics& statistics) {
  std::vector<double> means(kResamples, 0.0);
  for (const ScoredMetric& scored : scoring) {
    const auto& of_own = statistics.resampled_losses[loss_row(own.mode, scored.metric->id)];
    const auto& of_leader = statistics.resampled_losses[loss_row(leader.mode, scored.metric->id)];
    for (std::size_t i = 0; i < means.size(); ++i) {
      means[i] += scored.weight * (of_own[i] - of_leader[i]);
    }
  }
  std::sort(means.begin(), means.end());
  return means;
}

/// Interval of the ratio of a mode's score to the leader's, and the conclusion from it.
struct Behind {
  std::optional<Interval> ratio_ci95;  ///< 95 % interval of the ratio; absent below 2 samples
  Conclusion conclusion{};
};

Behind behind(const Entry& own, const Entry& leader, double relevance,
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

/// Divides a count of 1 equally among the entries whose value is within `margin` of the smallest,
/// because smaller differences do not matter. Only entries with Entry::completes are considered.
template <class Value>
void count_best(const std::vector<Entry>& entries, double margin, Value&& value,
                std::vector<double>& counts) {
  constexpr double kRounding = 1e-12;
  double least = value(entries.front());  // the first entry has completes == true
  for (const Entry& entry : entries) {
    if (entry.completes) least = std::min(least, value(entry));
  }
  const double most = least + margin + kRounding * (1.0 + std::abs(least));
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].completes && value(entries[i]) <= most) best.push_back(i);
  }
  for (const std::size_t i : best) counts[i] += 1.0 / static_cast<double>(best.size());
}

/// For each entry, the share of random weightings of the metrics for which it is best. The
/// weightings are uniformly distributed over all that sum to 1.
std::vector<double> shares_by_weights(const std::vector<Entry>& entries, double margin,
                                      Random random) {
  std::vector<double> shares(entries.size(), 0.0);
  std::vector<double> weights(entries.front().mean_losses.size());
  for (int draw = 0; draw < kWeightings; ++draw) {
    for (double& weight : weights) weight = -std::log1p(-random.uniform());  // Dirichlet(1, ..., 1)
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    const auto loss = [&](const Entry& entry) {
      return std::inner_product(weights.begin(), weights.end(), entry.mean_losses.begin(), 0.0);
    };
    count_best(entries, margin, loss, shares);
  }
  for (double& share : shares) share /= kWeightings;
  return shares;
}

std::vector<double> shares_by_samples(const std::vector<Entry>& entries, double margin) {
  const std::size_t n = entries.front().log_scores.size();
  std::vector<double> shares(entries.size(), 0.0);
  for (std::size_t sample = 0; sample < n; ++sample) {
    count_best(
        entries, margin, [&](const Entry& entry) { return entry.log_scores[sample]; }, shares);
  }
  for (double& share : shares) share /= static_cast<double>(n);
  return shares;
}

/// True if two modes are equivalent in every scored metric that both have. The difference of the
/// two scores then does not matter, even if it is significant.
bool equivalent_in_all(const Contender& a, const Contender& b,
                       const std::vector<ScoredMetric>& scoring,
                       const std::vector<PairedDifference>& differences) {
  bool any = false;
  for (const PairedDifference& d : differences) {
    const bool scored = std::any_of(scoring.begin(), scoring.end(), [&](const ScoredMetric& s) {
      return s.metric->id == d.metric;
    });
    if (!scored || !d.is_between(a, b) || !d.mean) continue;
    if (d.conclusion != Conclusion::kEquivalent) return false;
    any = true;
  }
  return any;
}

/// True if `other` is relevantly better than `own` in a scored metric, and relevantly worse in
/// none.
bool dominates(const Contender& other, const Contender& own,
               const std::vector<ScoredMetric>& scoring,
               const std::vector<PairedDifference>& differences) {
  bool better = false;
  for (const PairedDifference& d : differences) {
    const bool scored = std::any_of(scoring.begin(), scoring.end(), [&](const ScoredMetric& s) {
      return s.metric->id == d.metric;
    });
    if (!scored || !d.is_between(own, other) || d.conclusion != Conclusion::kRelevant) continue;
    const bool first_is_worse = *d.mean > 0.0;
    if (first_is_worse != (d.first == own)) return false;
    better = true;
  }
  return better;
}

/// Replaces first_by_weights of the modes that are tied for rank 1 by the mean over these modes,
/// because none of them has rank 1 alone. If they are equivalent, does the same with
/// first_by_samples.
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
  const std::vector<Entry> entries = sorted_entries(scenario, scoring);
  const double margin = std::log1p(preferences.relevance);
  const std::vector<double> by_weights =
      shares_by_weights(entries, margin, Random(seed, kWeightStream));
  const std::vector<double> by_samples = shares_by_samples(entries, margin);
  std::vector<RankedMode> ranking;
  std::size_t leader = 0;  // index of the best entry of the current rank
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Entry& own = entries[i];
    RankedMode ranked;
    ranked.contender = own.rows->contender;
    ranked.score = std::exp(own.log_score() - entries.front().log_score());
    ranked.completed_share = own.rows->completed_share();
    ranked.first_by_weights = by_weights[i];
    if (own.log_scores.size() >= 2) ranked.first_by_samples = by_samples[i];
    if (i > 0) {
      const auto behind_entry = [&](const Entry& other) {
        return behind(own, other, preferences.relevance, scoring, statistics);
      };
      const Behind first = behind_entry(entries.front());
      ranked.behind_ci95 = first.ratio_ci95;
      ranked.towards_leader =
          leader == 0 ? first.conclusion : behind_entry(entries[leader]).conclusion;
      const bool alike = complete_alike(*own.rows, *entries[leader].rows);
      if (alike && equivalent_in_all(own.rows->contender, entries[leader].rows->contender, scoring,
                                     statistics.differences)) {
        ranked.towards_leader = Conclusion::kEquivalent;
      }
      if (!alike || ranked.towards_leader == Conclusion::kRelevant) leader = i;
    }
    ranked.rank = static_cast<int>(leader) + 1;
    ranking.push_back(std::move(ranked));
  }
  share_firsts_of_ties(ranking);
  name_ties_and_dominance(ranking, scoring, statistics.differences);
  return ranking;
}

}  // namespace awmr
