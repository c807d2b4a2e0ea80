/// Rows of a comparison, grouped by scenario and contender, and their statistics: means, quantiles
/// and paired differences. Private to compare/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/compare/metric_columns.h"
#include "awmr/compare/preferences.h"
#include "awmr/core/index.h"
#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"

namespace awmr {

/// Rows of one contender in one scenario: sample 0 (the nominal model), then the drawn samples.
struct ModeRows {
  Contender contender;
  std::span<const ComparisonRow> rows;  ///< sample 0 first, then the drawn samples; never empty

  const Metrics& nominal() const { return rows.front().metrics; }
  /// Rows from which all statistics are computed: the rows of the drawn samples or, without drawn
  /// samples, the row of the nominal run.
  std::span<const ComparisonRow> counted() const {
    return rows.size() > 1 ? rows.subspan(1) : rows;
  }
  std::size_t completed_count() const;
  /// Share of the counted runs that complete the scenario, in [0, 1].
  double completed_share() const;
  std::string label() const { return contender.label(); }
};

/// Rows of one scenario, by contender.
struct ScenarioRows {
  std::string scenario;
  std::vector<ModeRows> modes;
};

/// Precondition: all samples are complete (evaluated_part()).
std::vector<ScenarioRows> group(const Comparison& comparison);
/// Returns the comparison without the samples that are not finished for all contenders.
Comparison evaluated_part(const Comparison& comparison);

/// Mean of one or more values.
double mean_of(std::span<const double> values);

/// Mean and quantiles of one metric of a contender.
struct Summary {
  std::optional<double> nominal;        ///< value in sample 0, the nominal model
  std::size_t count = 0;                ///< number of counted runs that have the metric
  std::optional<double> mean;           ///< mean over these runs
  std::optional<double> q05, q50, q95;  ///< quantiles; absent for fewer than 2 runs
};
Summary summarise(const ModeRows& rows, const MetricColumn& metric);

/// True if any mode has the metric in any counted run.
bool any_has(const ScenarioRows& scenario, const MetricColumn& metric);

/// Returns the fraction of the sorted bootstrap means to cut off at one end, so that the true mean
/// is beyond this end with the probability `tail` (Hesterberg's expanded percentiles):
///   Phi(-t sqrt(n/(n-1))),  t: the 1 - tail quantile of Student's t with n - 1 degrees of freedom
/// Phi is the standard normal distribution function, and n = `count` the number of values. Cutting
/// off `tail` itself would make intervals from few values too narrow. Below kFewSamples values,
/// intervals are too narrow even with this correction.
double bootstrap_tail(std::size_t count, double tail);

/// Conclusion about the difference of a metric between two modes, at a significance level of 5 %.
enum class Conclusion { kRelevant, kEquivalent, kUndecided };
inline constexpr NameTable<Conclusion, 3> kConclusionNames{{{"relevant", Conclusion::kRelevant},
                                                            {"equivalent", Conclusion::kEquivalent},
                                                            {"undecided", Conclusion::kUndecided}}};

/// Difference of a metric between two contenders, first minus second, computed sample by sample: in
/// a sample, both contenders have the same drawn vehicle and the same noise.
struct PairedDifference {
  Contender first;
  Contender second;
  const MetricColumn* metric = nullptr;  ///< an entry of kMetricColumns
  /// Difference in sample 0 (the nominal model), in the metric's unit.
  std::optional<double> nominal;
  std::size_t count = 0;         ///< number of samples with the metric in both contenders
  std::optional<double> mean;    ///< mean difference over these samples, in the metric's unit
  std::optional<Interval> ci95;  ///< 95 % interval of the mean; absent for fewer than 2 samples
  std::optional<double> p;       ///< p-value of the paired t test; absent for fewer than 2 samples
  /// p with Holm's correction for the number of differences in the scenario. Below 0.05, the
  /// difference is significant. The probability of any false positive in the scenario is then at
  /// most 5 %.
  std::optional<double> p_holm;
  /// Largest difference that does not matter, in the metric's unit, >= 0: the metric's floor, or
  /// the relevance times the smaller of the two means if this is larger.
  double margin = 0.0;
  /// p-value of two one-sided t tests (TOST) for equivalence, in [0, 1]. Below 0.05, the difference
  /// is significantly smaller in magnitude than the margin. Absent below 2 samples.
  std::optional<double> p_equivalent;
  /// kRelevant if p_holm is below 0.05 and the whole interval ci95 is beyond the margin; else
  /// kEquivalent if p_equivalent is below 0.05, else kUndecided. For a single run: kRelevant if the
  /// difference is beyond the margin, else kEquivalent. Absent without a mean.
  std::optional<Conclusion> conclusion;

  bool is_between(const Contender& a, const Contender& b) const {
    return (first == a && second == b) || (first == b && second == a);
  }
};

/// Significance level of all tests of a comparison.
inline constexpr double kSignificance = 0.05;

/// Holm's step-down correction of p-values. Returns them in the given order.
std::vector<double> holm(std::span<const double> p);

inline constexpr int kResamples = 1000;  ///< number of bootstrap resamples

/// Statistics of one scenario. All intervals are from one bootstrap, which draws samples with
/// replacement, each with all its metrics and contenders. Every scenario uses the same resamples,
/// so its intervals do not depend on the other scenarios.
struct ScenarioStatistics {
  /// Differences of every metric between every pair of contenders with the same gains or the same
  /// mode.
  std::vector<PairedDifference> differences;
  /// Means of log_loss() (scoring.h) for each mode and metric (index: loss_row()), in each
  /// bootstrap resample. A weighted sum of these rows is the mean score in each resample, from
  /// which the interval of the score follows. 0 for metrics that are never ranked; empty below 2
  /// samples.
  std::vector<std::vector<double>> resampled_losses;
};

/// Row of a mode (index in ScenarioRows::modes) and a metric in the resampled losses.
inline std::size_t loss_row(std::size_t mode, const MetricColumn& metric) {
  return mode * kMetricColumns.size() + at(&metric - kMetricColumns.data());
}

ScenarioStatistics statistics_of(const ScenarioRows& scenario, const Preferences& preferences,
                                 std::uint64_t seed);

}  // namespace awmr
