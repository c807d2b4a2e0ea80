/// Mean, quantiles and paired differences of a comparison's rows. Private to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/compare/metric_columns.h"
#include "awmr/compare/preferences.h"
#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"

namespace awmr {

/// The rows of one contender in one scenario: the model's own (sample 0), then the drawn ones.
struct ModeRows {
  Contender contender;
  std::span<const ComparisonRow> rows;  ///< never empty

  const Metrics& nominal() const { return rows.front().metrics; }
  /// Samples of the statistics: the drawn ones, or the nominal run if there are none.
  std::span<const ComparisonRow> counted() const {
    return rows.size() > 1 ? rows.subspan(1) : rows;
  }
  std::size_t completed_count() const;
  /// Share of the counted runs that completed, in [0, 1].
  double completed_share() const;
  std::string label() const { return contender.label(); }
};

struct ScenarioRows {
  std::string scenario;
  std::vector<ModeRows> modes;
};

/// All rows; precondition: complete samples, see evaluated_part().
std::vector<ScenarioRows> group(const Comparison& comparison);
/// The comparison without samples that some contenders have not finished.
Comparison evaluated_part(const Comparison& comparison);

struct Summary {
  std::optional<double> nominal;
  std::size_t count = 0;                ///< counted runs that have the metric
  std::optional<double> mean;           ///< over those
  std::optional<double> q05, q50, q95;  ///< absent for fewer than 2
};
Summary summarise(const ModeRows& rows, const MetricColumn& metric);

/// True if any mode has the metric in any counted run.
bool any_has(const ScenarioRows& scenario, const MetricColumn& metric);

/// Share of resampled means to cut on each side for a coverage error of `tail`: Phi(-t
/// sqrt(n/(n-1))), t of n - 1 degrees of freedom (Hesterberg's expanded percentiles). Plain
/// bootstrap percentiles are too narrow for few values; below kFewSamples values the coverage is
/// still too low.
double bootstrap_tail(std::size_t count, double tail);

/// Linear between order statistics (type 7 of Hyndman and Fan). `sorted` is not empty, p in [0, 1].
double quantile(std::span<const double> sorted, double p);

/// Conclusion about a difference, at the 5 % level.
enum class Conclusion { kRelevant, kEquivalent, kUndecided };
inline constexpr NameTable<Conclusion, 3> kConclusionNames{{{"relevant", Conclusion::kRelevant},
                                                            {"equivalent", Conclusion::kEquivalent},
                                                            {"undecided", Conclusion::kUndecided}}};

/// Paired difference, first minus second: the same drawn vehicle and noise in both modes.
struct PairedDifference {
  Contender first;
  Contender second;
  MetricId metric{};
  std::optional<double> nominal;  ///< of sample 0, in the metric's unit
  std::size_t count = 0;          ///< samples that have the metric in both modes
  std::optional<double> mean;     ///< over those, in the metric's unit
  std::optional<Interval> ci95;   ///< of the mean; absent for fewer than 2
  std::optional<double> p;        ///< of the paired t test, in [0, 1]; absent for fewer than 2
  /// p corrected for all differences of the scenario (Holm): below 0.05 the difference is
  /// significant, with at most a 5 % risk of any false positive in the whole scenario.
  std::optional<double> p_holm;
  /// Irrelevance margin in the metric's unit, >= 0: the larger of the metric's floor and the
  /// relevance times the smaller mean.
  double margin = 0.0;
  /// p-value of two one-sided t tests (TOST), in [0, 1]: below 0.05 the difference is within the
  /// margin. Absent below 2 samples.
  std::optional<double> p_equivalent;
  /// Relevant if Holm's p is below 0.05 and the whole interval is beyond the margin; for a single
  /// run, if the difference is beyond the margin. Absent without a mean.
  std::optional<Conclusion> conclusion;

  bool is_between(const Contender& a, const Contender& b) const {
    return (first == a && second == b) || (first == b && second == a);
  }
};

inline constexpr double kSignificance = 0.05;

/// Holm's step-down correction, in the order given.
std::vector<double> holm(std::span<const double> p);

inline constexpr int kResamples = 1000;
/// 95 % intervals of the mean by the percentile bootstrap: whole samples are resampled, the same
/// ones for every metric, pair and scenario, so that no interval depends on the order of scenarios.
/// The two of a pair have the same gains or the same mode.
std::vector<PairedDifference> paired_differences(const ScenarioRows& scenario,
                                                 const Preferences& preferences,
                                                 std::uint64_t seed);

}  // namespace awmr
