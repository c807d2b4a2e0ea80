#include "awmr/compare/ranking.h"

#include <algorithm>
#include <numeric>

#include "awmr/compare/binomial.h"
#include "awmr/core/random.h"

namespace awmr {
namespace {

/// The bootstrap of scores is apart from that of differences (statistics.cpp) and from the draws.
constexpr std::uint64_t kScoreStream = std::uint64_t{3} << 62U;

/// Whether some mode was judged by how well it followed a command.
bool has_a_goal(const ScenarioRows& scenario) {
  return std::any_of(scenario.modes.begin(), scenario.modes.end(), [](const ModeRows& rows) {
    const Metrics& m = rows.nominal();
    return m.heading_iae_degs || m.cross_track_rms_m || m.finish_time_s;
  });
}

/// The metrics that rank this scenario's modes, with their scales.
struct MetricScale {
  const MetricColumn* metric;
  double scale;
};

std::vector<MetricScale> scales_of(const ScenarioRows& scenario) {
  std::vector<MetricScale> scales;
  for (const MetricColumn& metric : kMetricColumns) {
    if (metric.ranked() && any_has(scenario, metric)) {
      scales.push_back({&metric, ranking_scale(scenario, metric)});
    }
  }
  return scales;
}

/// Mean of one mode's metric over its runs, over the scale; 1 where it has none.
double score_of(const ModeRows& rows, const std::vector<MetricScale>& scales) {
  double sum = 0.0;
  for (const MetricScale& scale : scales) {
    const auto mean = summarise(rows, *scale.metric).mean;
    sum += mean ? *mean / scale.scale : 1.0;
  }
  return scales.empty() ? 0.0 : sum / static_cast<double>(scales.size());
}

/// One run's score on the same scales.
double score_of(const Metrics& metrics, const std::vector<MetricScale>& scales) {
  double sum = 0.0;
  for (const MetricScale& scale : scales) {
    const auto value = scale.metric->value(metrics);
    sum += value ? *value / scale.scale : 1.0;
  }
  return sum / static_cast<double>(scales.size());
}

/// 95 % interval of the mean of a's score minus b's, sample by sample.
Interval score_difference(const ModeRows& a, const ModeRows& b,
                          const std::vector<MetricScale>& scales, Random random) {
  const auto first = a.counted();
  const auto second = b.counted();
  std::vector<double> by_sample;
  for (std::size_t i = 0; i < first.size(); ++i) {
    by_sample.push_back(score_of(first[i].metrics, scales) - score_of(second[i].metrics, scales));
  }
  const auto n = static_cast<double>(by_sample.size());
  std::vector<double> means;
  for (int resample = 0; resample < kResamples; ++resample) {
    double sum = 0.0;
    for (std::size_t i = 0; i < by_sample.size(); ++i) {
      sum += by_sample[static_cast<std::size_t>(random.uniform() * n)];
    }
    means.push_back(sum / n);
  }
  std::sort(means.begin(), means.end());
  return {quantile(means, 0.025), quantile(means, 0.975)};
}

/// Whether the two shares of completed runs are not told apart: by the exact McNemar test, or for a
/// single run by being equal.
bool complete_alike(const ModeRows& a, const ModeRows& b) {
  const auto first = a.counted();
  const auto second = b.counted();
  if (first.size() < 2) return a.completed_count() == b.completed_count();
  std::size_t only_first = 0;
  std::size_t only_second = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i].metrics.completed && !second[i].metrics.completed) ++only_first;
    if (second[i].metrics.completed && !first[i].metrics.completed) ++only_second;
  }
  return mcnemar_p(only_first, only_second) >= kSignificance;
}

const ModeRows& runs_of(const ScenarioRows& scenario, const RankedMode& ranked) {
  return *std::find_if(scenario.modes.begin(), scenario.modes.end(),
                       [&](const ModeRows& rows) { return rows.contender == ranked.contender; });
}

/// Best first, ranks not yet given.
std::vector<RankedMode> sorted_modes(const ScenarioRows& scenario,
                                     const std::vector<MetricScale>& scales) {
  std::vector<RankedMode> ranked;
  for (const ModeRows& rows : scenario.modes) {
    ranked.push_back({.rank = 0,
                      .contender = rows.contender,
                      .score = score_of(rows, scales),
                      .completed_share = rows.completed_share(),
                      .behind_ci95 = {},
                      .tied_with = {}});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedMode& a, const RankedMode& b) {
    if (a.completed_share > b.completed_share) return true;
    if (a.completed_share < b.completed_share) return false;
    return a.score < b.score;
  });
  return ranked;
}

}  // namespace

double ranking_scale(const ScenarioRows& scenario, const MetricColumn& metric) {
  double worst = metric.ranking_floor;
  for (const ModeRows& rows : scenario.modes) {
    worst = std::max(worst, summarise(rows, metric).mean.value_or(0.0));
  }
  return worst;
}

std::vector<RankedMode> rank(const ScenarioRows& scenario, std::uint64_t seed,
                             std::uint64_t stream) {
  if (!has_a_goal(scenario)) return {};
  const std::vector<MetricScale> scales = scales_of(scenario);
  std::vector<RankedMode> ranked = sorted_modes(scenario, scales);
  std::size_t leader = 0;  // the best of the current rank
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const ModeRows& own = runs_of(scenario, ranked[i]);
    const ModeRows& best = runs_of(scenario, ranked[leader]);
    bool near = ranked[i].score - ranked[leader].score <= kTieMargin;
    if (i != leader && own.counted().size() >= 2) {
      ranked[i].behind_ci95 =
          score_difference(own, best, scales, Random(seed, kScoreStream | (stream << 8U) | i));
      near = near || ranked[i].behind_ci95->contains(0.0);
    }
    if (!near || !complete_alike(own, best)) leader = i;
    ranked[i].rank = static_cast<int>(leader) + 1;
  }
  for (RankedMode& mode : ranked) {
    for (const RankedMode& other : ranked) {
      if (other.rank == mode.rank && other.contender != mode.contender) {
        mode.tied_with.push_back(other.contender.label());
      }
    }
  }
  return ranked;
}

}  // namespace awmr
