#include "awmr/compare/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "awmr/compare/binomial.h"
#include "awmr/core/index.h"
#include "awmr/core/random.h"

namespace awmr {
namespace {

/// Streams of the bootstrap are apart from those of the draws, which are sample numbers.
constexpr std::uint64_t kBootstrapStream = std::uint64_t{1} << 63U;

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::optional<double> difference(const MetricColumn& metric, const Metrics& a, const Metrics& b) {
  const auto x = metric.value(a);
  const auto y = metric.value(b);
  if (!x || !y) return std::nullopt;
  return *x - *y;
}

/// A pair's differences by sample, absent where one of the modes has no value.
struct Series {
  PairedDifference result;
  std::vector<std::optional<double>> by_sample;
  std::vector<double> resampled_means;
};

double margin_between(const ModeRows& a, const ModeRows& b, const MetricColumn& metric,
                      double relevance) {
  const double first = summarise(a, metric).mean.value_or(0.0);
  const double second = summarise(b, metric).mean.value_or(0.0);
  return std::max(metric.ranking_floor, relevance * std::min(std::abs(first), std::abs(second)));
}

/// Once the interval and Holm's p are there.
std::optional<Conclusion> conclusion_of(const PairedDifference& d) {
  if (!d.mean) return std::nullopt;
  if (!d.ci95 || !d.p_holm || !d.p_equivalent) {
    return std::abs(*d.mean) > d.margin ? Conclusion::kRelevant : Conclusion::kEquivalent;
  }
  const bool beyond = d.ci95->lo > d.margin || d.ci95->hi < -d.margin;
  if (beyond && *d.p_holm < kSignificance) return Conclusion::kRelevant;
  return *d.p_equivalent < kSignificance ? Conclusion::kEquivalent : Conclusion::kUndecided;
}

Series series_of(const ModeRows& first, const ModeRows& second, const MetricColumn& metric,
                 double relevance) {
  Series series;
  series.result.margin = margin_between(first, second, metric, relevance);
  series.result.first = first.contender;
  series.result.second = second.contender;
  series.result.metric = metric.id;
  series.result.nominal = difference(metric, first.nominal(), second.nominal());
  const auto a = first.counted();
  const auto b = second.counted();
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto d = difference(metric, a[i].metrics, b[i].metrics);
    series.by_sample.push_back(d);
    if (!d) continue;
    sum += *d;
    ++series.result.count;
  }
  if (series.result.count == 0) return series;
  const double mean = sum / static_cast<double>(series.result.count);
  series.result.mean = mean;
  if (series.result.count < 2) return series;
  double squares = 0.0;
  for (const auto& d : series.by_sample) {
    if (d) squares += (*d - mean) * (*d - mean);
  }
  const double deviation = std::sqrt(squares / static_cast<double>(series.result.count - 1));
  series.result.p = paired_t_p(mean, deviation, series.result.count);
  series.result.p_equivalent =
      equivalence_p(mean, deviation, series.result.count, series.result.margin);
  return series;
}

/// One resample's mean of each series.
void add_resample(std::span<const std::size_t> chosen, std::vector<Series>& all) {
  for (Series& series : all) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const std::size_t i : chosen) {
      if (!series.by_sample[i]) continue;
      sum += *series.by_sample[i];
      ++count;
    }
    if (count > 0) series.resampled_means.push_back(sum / static_cast<double>(count));
  }
}

/// Every metric of every pair of the same gains or of the same mode.
std::vector<Series> all_series(const ScenarioRows& scenario, double relevance) {
  std::vector<Series> all;
  for (std::size_t i = 0; i < scenario.modes.size(); ++i) {
    for (std::size_t j = i + 1; j < scenario.modes.size(); ++j) {
      const ModeRows& a = scenario.modes[i];
      const ModeRows& b = scenario.modes[j];
      const bool comparable =
          a.contender.mode == b.contender.mode || a.contender.gains == b.contender.gains;
      if (!comparable) continue;
      for (const MetricColumn& metric : kMetricColumns) {
        all.push_back(series_of(a, b, metric, relevance));
      }
    }
  }
  return all;
}

/// The bootstrap: nothing below two samples.
void resample(std::vector<Series>& all, std::size_t samples, Random random) {
  if (samples < 2) return;
  std::vector<std::size_t> chosen(samples);
  for (int round = 0; round < kResamples; ++round) {
    for (std::size_t& index : chosen) {
      index = static_cast<std::size_t>(random.uniform() * static_cast<double>(samples));
    }
    add_resample(chosen, all);
  }
}

Contender contender_of(const ComparisonRow& row) { return {row.mode, row.gains}; }

/// Fills in p_holm from the p of all differences.
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
  const auto runs = counted();
  return at(std::count_if(runs.begin(), runs.end(),
                          [](const ComparisonRow& row) { return row.metrics.completed; }));
}

double ModeRows::completed_share() const {
  return static_cast<double>(completed_count()) / static_cast<double>(counted().size());
}

std::string Contender::label() const {
  const std::string name(name_of(mode));
  return gains.empty() ? name : name + " with " + gains;
}

Comparison judged_part(const Comparison& comparison) {
  Comparison part{.rows = {},
                  .whole_samples = comparison.whole_samples,
                  .stopped = comparison.stopped,
                  .arithmetic = comparison.arithmetic};
  for (const ComparisonRow& row : comparison.rows) {
    if (row.sample < comparison.whole_samples) part.rows.push_back(row);
  }
  return part;
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> corrected(p.size());
  double largest = 0.0;  // of the smaller ones: the correction keeps their order
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, static_cast<double>(p.size() - i) * p[order[i]]);
    corrected[order[i]] = std::min(1.0, largest);
  }
  return corrected;
}

std::vector<ScenarioRows> group(const Comparison& comparison) {
  std::vector<ScenarioRows> scenarios;
  const std::span<const ComparisonRow> rows = comparison.rows;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin;
    while (end < rows.size() && rows[end].scenario == rows[begin].scenario &&
           contender_of(rows[end]) == contender_of(rows[begin])) {
      ++end;
    }
    if (scenarios.empty() || scenarios.back().scenario != rows[begin].scenario) {
      scenarios.push_back({rows[begin].scenario, {}});
    }
    scenarios.back().modes.push_back({contender_of(rows[begin]), rows.subspan(begin, end - begin)});
    begin = end;
  }
  return scenarios;
}

bool any_has(const ScenarioRows& scenario, const MetricColumn& metric) {
  return std::any_of(scenario.modes.begin(), scenario.modes.end(), [&](const ModeRows& rows) {
    return summarise(rows, metric).mean.has_value();
  });
}

double quantile(std::span<const double> sorted, double p) {
  const double position = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
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
  summary.q05 = quantile(values, 0.05);
  summary.q50 = quantile(values, 0.50);
  summary.q95 = quantile(values, 0.95);
  return summary;
}

std::vector<PairedDifference> paired_differences(const ScenarioRows& scenario,
                                                 const Preferences& preferences, std::uint64_t seed,
                                                 std::uint64_t stream) {
  std::vector<Series> all = all_series(scenario, preferences.relevance);
  resample(all, scenario.modes.front().rows.size() - 1, Random(seed, kBootstrapStream + stream));
  std::vector<PairedDifference> differences;
  for (Series& series : all) {
    if (series.result.count >= 2 && !series.resampled_means.empty()) {
      std::sort(series.resampled_means.begin(), series.resampled_means.end());
      series.result.ci95 = Interval{quantile(series.resampled_means, 0.025),
                                    quantile(series.resampled_means, 0.975)};
    }
    differences.push_back(series.result);
  }
  correct(differences);
  for (PairedDifference& d : differences) d.conclusion = conclusion_of(d);
  return differences;
}

}  // namespace awmr
