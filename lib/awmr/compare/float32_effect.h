/// What steps of float32 change in a comparison: its checked samples (kCheckedSamples) in float32
/// beside the same in double. Private to this folder.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/compare/statistics.h"

namespace awmr {

/// The effect on a metric, float32 less double, over the checked runs of a contender in a scenario.
struct Float32Effect {
  std::string scenario;
  Contender contender;
  MetricId metric{};
  std::size_t count = 0;  ///< runs that have the metric in float32 and in double
  std::size_t lost = 0;   ///< runs that have it in one of them alone
  double largest = 0.0;   ///< of the absolute values, in the metric's unit, as all below
  int largest_sample = 0;
  double rms = 0.0;
  /// Standard deviation over the drawn samples in double: absent below 2 of them.
  std::optional<double> spread;
  /// A difference below it does not matter: the metric's floor, or the share `relevance` of the
  /// mean of the checked runs, whichever is more.
  double margin = 0.0;

  /// `value` over the spread; absent where there is none, or the metric is the same in all samples.
  std::optional<double> of_spread(double value) const;
  /// The rms over what is looked at, spread or margin, whichever is more; 0 where it is 0.
  double size() const;
  /// float32 is not for this metric: its rms is beyond kSmallShare of the spread and of the margin,
  /// or a run has lost it.
  bool matters() const;
};
inline constexpr double kSmallShare = 0.05;

/// A pair of contenders of which float32 tells something else than double does.
struct ChangedConclusion {
  std::string scenario;
  Contender first, second;
  MetricId metric{};
  std::optional<Conclusion> in_float32, in_double;
};

struct Float32Check {
  int samples = 0;            ///< checked, the nominal one included; 0: stopped before they were
  std::size_t in_double = 0;  ///< runs of the comparison that float32 could not follow
  std::size_t completed_otherwise = 0;  ///< checked runs that completed in one of them alone
  std::vector<Float32Effect> effects;   ///< by scenario, contender, metric that some run has
  std::vector<ChangedConclusion> changed;
};

/// Of a comparison in float32. Conclusions are those of paired_differences() over the checked
/// samples.
Float32Check check_of(const Comparison& comparison, const CompareOptions& options);

/// The metrics by their largest effect in any scenario and mode, the most first: the worst four.
std::string float32_table(const Float32Check& check);

}  // namespace awmr
