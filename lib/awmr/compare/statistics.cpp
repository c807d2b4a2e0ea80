#include "awmr/compare/statistics.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "awmr/compare/scoring.h"
#include "awmr/core/random.h"
#include "awmr/core/statistics/binomial.h"
#include "awmr/core/statistics/distributions.h"
#include "awmr/core/statistics/sample_quantile.h"

namespace awmr {
namespace {

/// Random stream of the bootstrap; the drawn samples have the streams of their numbers.
constexpr std::uint64_t kBootstrapStream = std::uint64_t{1} << 63U;

std::optional<double> difference(const MetricColumn& metric, const Metrics& a, const Metrics& b) {
  const auto x = metric.value(a);
  const auto y = metric.value(b);
  if (!x || !y) return std::nullopt;
  return *x - *y;
}

/// Differences of all metrics between all pairs of contenders. Each row is one metric of one pair,
/// each column one sample, so that a bootstrap resample is a sum of columns.
struct Differences {
  std::vector<PairedDifference> results;
  Eigen::ArrayXXd values;  ///< difference; 0 if a contender of the pair has no value
  Eigen::ArrayXXd counts;  ///< 1 if both contenders of the pair have a value, else 0
};

double margin_between(const ModeRows& a, const ModeRows& b, const MetricColumn& metric,
                      double relevance) {
  const double first = summarise(a, metric).mean.value_or(0.0);
  const double second = summarise(b, metric).mean.value_or(0.0);
  return std::max(metric.ranking_floor, relevance * std::min(std::abs(first), std::abs(second)));
}

/// Applies the rule at PairedDifference::conclusion.
std::optional<Conclusion> conclusion_of(const PairedDifference& d) {
  if (!d.mean) return std::nullopt;
  if (!d.ci95 || !d.p_holm || !d.p_equivalent) {
    return std::abs(*d.mean) > d.margin ? Conclusion::kRelevant : Conclusion::kEquivalent;
  }
  const bool beyond = d.ci95->lo > d.margin || d.ci95->hi < -d.margin;
  if (beyond && *d.p_holm < kSignificance) return Conclusion::kRelevant;
  return *d.p_equivalent < kSignificance ? Conclusion::kEquivalent : Conclusion::kUndecided;
}

/// Returns the statistics of the differences of one metric between two contenders. Writes the
/// difference of each sample to `values`, and to `counts` whether it exists (1 or 0).
PairedDifference difference_of(const ModeRows& first, const ModeRows& second,
                               const MetricColumn& metric, double relevance,
                               Eigen::ArrayXXd::RowXpr values, Eigen::ArrayXXd::RowXpr counts) {
  PairedDifference result;
  result.margin = margin_between(first, second, metric, relevance);
  result.first = first.contender;
  result.second = second.contender;
  result.metric = &metric;
  result.nominal = difference(metric, first.nominal(), second.nominal());
  const auto a = first.counted();
  const auto b = second.counted();
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto d = difference(metric, a[i].metrics, b[i].metrics);
    if (!d) continue;
    values[eigen_index(i)] = *d;
    counts[eigen_index(i)] = 1.0;
    sum += *d;
    ++result.count;
  }
  if (result.count == 0) return result;
  const double mean = sum / static_cast<double>(result.count);
  result.mean = mean;
  if (result.count < 2) return result;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (counts[i] > 0.0) squares += (values[i] - mean) * (values[i] - mean);
  }
  const double deviation = std::sqrt(squares / static_cast<double>(result.count - 1));
  result.p = paired_t_p(mean, deviation, result.count);
  result.p_equivalent = equivalence_p(mean, deviation, result.count, result.margin);
  return result;
}

/// Returns the pairs of contenders to compare: those with the same gains or the same mode.
std::vector<std::pair<const ModeRows*, const ModeRows*>> comparable_pairs(
    const ScenarioRows& scenario) {
  std::vector<std::pair<const ModeRows*, const ModeRows*>> pairs;
  for (std::size_t i = 0; i < scenario.modes.size(); ++i) {
    for (std::size_t j = i + 1; j < scenario.modes.size(); ++j) {
      const ModeRows& a = scenario.modes[i];
      const ModeRows& b = scenario.modes[j];
      const bool comparable =
          a.contender.mode == b.contender.mode || a.contender.gains == b.contender.gains;
      if (comparable) pairs.emplace_back(&a, &b);
    }
  }
  return pairs;
}

Differences all_differences(const ScenarioRows& scenario, double relevance) {
  const auto pairs = comparable_pairs(scenario);
  const Eigen::Index rows = eigen_index(pairs.size() * std::size(kMetricColumns));
  const Eigen::Index samples = eigen_index(scenario.modes.front().counted().size());
  Differences all{{}, Eigen::ArrayXXd::Zero(rows, samples), Eigen::ArrayXXd::Zero(rows, samples)};
  for (const auto& [first, second] : pairs) {
    for (const MetricColumn& metric : kMetricColumns) {
      const Eigen::Index row = eigen_index(all.results.size());
      all.results.push_back(difference_of(*first, *second, metric, relevance, all.values.row(row),
                                          all.counts.row(row)));
    }
  }
  return all;
}

/// Returns log_loss() in every metric that can be used to rank modes, for the counted runs of every
/// mode. Rows as in ScenarioStatistics::resampled_losses; each column is a sample.
Eigen::ArrayXXd all_losses(const ScenarioRows& scenario, const Preferences& preferences) {
  Eigen::ArrayXXd losses =
      Eigen::ArrayXXd::Zero(eigen_index(scenario.modes.size() * std::size(kMetricColumns)),
                            eigen_index(scenario.modes.front().counted().size()));
  for (const ScoredMetric& scored : rankable_metrics(scenario, preferences)) {
    for (std::size_t mode = 0; mode < scenario.modes.size(); ++mode) {
      auto row = losses.row(eigen_index(loss_row(mode, *scored.metric)));
      Eigen::Index sample = 0;
      for (const ComparisonRow& run : scenario.modes[mode].counted()) {
        row[sample++] = log_loss(run.metrics, scored);
      }
    }
  }
  return losses;
}

/// Means over the samples in the bootstrap. Each column is one resample.
struct ResampledMeans {
  Eigen::ArrayXXd differences;  ///< same rows as Differences; NaN if a resample has no value
  Eigen::ArrayXXd losses;       ///< same rows as all_losses()
};

ResampledMeans resampled_means(const Differences& all, const Eigen::ArrayXXd& losses,
                               Random random) {
  const Eigen::Index samples = all.values.cols();
  ResampledMeans means{Eigen::ArrayXXd::Zero(all.values.rows(), kResamples),
                       Eigen::ArrayXXd::Zero(losses.rows(), kResamples)};
  Eigen::ArrayXd counts(all.values.rows());
  for (Eigen::Index resample = 0; resample < kResamples; ++resample) {
    auto difference = means.differences.col(resample);
    auto loss = means.losses.col(resample);
    counts.setZero();
    for (Eigen::Index i = 0; i < samples; ++i) {
      const auto chosen =
          static_cast<Eigen::Index>(random.uniform() * static_cast<double>(samples));
      difference += all.values.col(chosen);
      counts += all.counts.col(chosen);
      loss += losses.col(chosen);
    }
    difference /= counts;
  }
  means.losses /= static_cast<double>(samples);
  return means;
}

/// 95 % interval of a mean over `values` samples. Empty if no resample has a value.
std::optional<Interval> interval_of(Eigen::ArrayXXd::ConstRowXpr means, std::size_t values) {
  std::vector<double> sorted;
  for (const double mean : means) {
    if (!std::isnan(mean)) sorted.push_back(mean);
  }
  if (sorted.empty()) return std::nullopt;
  std::sort(sorted.begin(), sorted.end());
  const double tail = bootstrap_tail(values, 0.025);
  return Interval{quantile_of_sorted(sorted, tail), quantile_of_sorted(sorted, 1.0 - tail)};
}

/// Computes p_holm of all differences from their p-values (Holm's correction for multiple tests).
void correct(std::vector<PairedDifference>& differences) {
  std::vector<double> p;
  for (const PairedDifference& d : differences) {
    if (d.p) p.push_back(*d.p);
  }
  const std::vector<double> corrected = holm(p);
  std::size_t next = 0;
  for (PairedDifference& d : differences) {
    if (d.p) d.p_holm = corrected[next++];
  }
}

}  // namespace

std::size_t ModeRows::completed_count() const {
  return at(std::ranges::count_if(counted(),
                                  [](const ComparisonRow& row) { return row.metrics.completed; }));
}

double ModeRows::completed_share() const {
  return static_cast<double>(completed_count()) / static_cast<double>(counted().size());
}

Comparison evaluated_part(const Comparison& comparison) {
  Comparison part{.rows = {},
                  .whole_samples = comparison.whole_samples,
                  .stopped = comparison.stopped,
                  .arithmetic = comparison.arithmetic,
                  .changes = comparison.changes};
  for (const ComparisonRow& row : comparison.rows) {
    if (row.sample < comparison.whole_samples) part.rows.push_back(row);
  }
  return part;
}

std::vector<ScenarioRows> group(const Comparison& comparison) {
  std::vector<ScenarioRows> scenarios;
  for (const ComparisonRow& row : comparison.rows) {
    if (scenarios.empty() || scenarios.back().scenario != row.scenario) {
      scenarios.push_back({row.scenario, {}});
    }
    std::vector<ModeRows>& modes = scenarios.back().modes;
    const Contender contender{row.mode, row.gains};
    if (modes.empty() || modes.back().contender != contender) modes.push_back({contender, {}});
    const std::size_t before = modes.back().rows.size();
    modes.back().rows = {&row - before, before + 1};
  }
  return scenarios;
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> corrected(p.size());
  double largest = 0.0;  // largest corrected p so far: a larger p never gets a smaller correction
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(p.size() - i) * p[order[i]]);
    corrected[order[i]] = std::min(1.0, largest);
  }
  return corrected;
}

bool any_has(const ScenarioRows& scenario, const MetricColumn& metric) {
  return std::any_of(scenario.modes.begin(), scenario.modes.end(), [&](const ModeRows& rows) {
    return summarise(rows, metric).mean.has_value();
  });
}

double bootstrap_tail(std::size_t count, double tail) {
  if (count < 2) return tail;
  const auto n = static_cast<double>(count);
  const double t = students_t_quantile(1.0 - tail, n - 1.0);
  return normal_cdf(-t * std::sqrt(n / (n - 1.0)));
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Summary summarise(const ModeRows& rows, const MetricColumn& metric) {
  Summary summary;
  summary.nominal = metric.value(rows.nominal());
  std::vector<double> values;
  for (const ComparisonRow& row : rows.counted()) {
    if (const auto value = metric.value(row.metrics)) values.push_back(*value);
  }
  summary.count = values.size();
  if (values.empty()) return summary;
  summary.mean = mean_of(values);
  if (values.size() < 2) return summary;
  std::sort(values.begin(), values.end());
  summary.q05 = quantile_of_sorted(values, 0.05);
  summary.q50 = quantile_of_sorted(values, 0.50);
  summary.q95 = quantile_of_sorted(values, 0.95);
  return summary;
}

ScenarioStatistics statistics_of(const ScenarioRows& scenario, const Preferences& preferences,
                                 std::uint64_t seed) {
  Differences all = all_differences(scenario, preferences.relevance);
  ScenarioStatistics statistics{std::move(all.results), {}};
  std::vector<PairedDifference>& differences = statistics.differences;
  if (all.values.cols() >= 2) {
    const ResampledMeans means =
        resampled_means(all, all_losses(scenario, preferences), Random(seed, kBootstrapStream));
    for (std::size_t i = 0; i < differences.size(); ++i) {
      PairedDifference& d = differences[i];
      if (d.count >= 2) d.ci95 = interval_of(means.differences.row(eigen_index(i)), d.count);
    }
    for (const auto& row : means.losses.rowwise()) {
      statistics.resampled_losses.emplace_back(row.begin(), row.end());
    }
  }
  correct(differences);
  for (PairedDifference& d : differences) d.conclusion = conclusion_of(d);
  return statistics;
}

}  // namespace awmr
