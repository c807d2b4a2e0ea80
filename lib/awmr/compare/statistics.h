/// Mean, quantiles and paired differences of a comparison's rows. Private to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/compare/metric_columns.h"
#include "awmr/core/interval.h"

namespace awmr {

/// The rows of one scenario in one mode: the model's own (sample 0), then the drawn ones.
struct ModeRows {
  YawMode mode{};
  std::span<const ComparisonRow> rows;

  const Metrics& nominal() const { return rows.front().metrics; }
  /// What the statistics are over: the drawn samples, or the nominal run where none was drawn.
  std::span<const ComparisonRow> counted() const {
    return rows.size() > 1 ? rows.subspan(1) : rows;
  }
  /// Share of the counted runs that completed, in [0, 1].
  double completed_share() const;
};

struct ScenarioRows {
  std::string scenario;
  std::vector<ModeRows> modes;
};

std::vector<ScenarioRows> group(const Comparison& comparison);

struct Summary {
  std::optional<double> nominal;
  std::size_t count = 0;                ///< counted runs that have the metric
  std::optional<double> mean;           ///< over those
  std::optional<double> q05, q50, q95;  ///< absent for fewer than 2
};
Summary summarise(const ModeRows& rows, const MetricColumn& metric);

/// Linear between order statistics (type 7 of Hyndman and Fan). `sorted` is not empty, p in [0, 1].
double quantile(std::span<const double> sorted, double p);

/// first minus second, sample by sample: the same drawn vehicle in both modes.
struct PairedDifference {
  YawMode first{};
  YawMode second{};
  std::string_view metric;
  std::optional<double> nominal;
  std::size_t count = 0;         ///< samples that have the metric in both modes
  std::optional<double> mean;    ///< over those
  std::optional<Interval> ci95;  ///< of the mean; absent for fewer than 2
};

inline constexpr int kResamples = 1000;
/// 95 % intervals of the mean by the percentile bootstrap: whole samples are resampled, the same
/// ones for every metric and pair. `stream` separates scenarios.
std::vector<PairedDifference> paired_differences(const ScenarioRows& scenario, std::uint64_t seed,
                                                 std::uint64_t stream);

}  // namespace awmr
