#include "rounded_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "even_times.h"

namespace awmr {
namespace {

constexpr double kTick_s = 1e-6;  ///< times are compared in multiples of this
constexpr std::size_t kMinRows = 20;
/// Minimum number of time steps that differ from the usual step. If fewer differ, single rows were
/// late, and the times are not rounded.
constexpr int kMinUnequal = 10;
/// Smallest resolution, as a fraction of the usual time step, for which rounded times are replaced.
/// Finer rounding does not matter.
constexpr double kMatters = 0.01;
/// Smallest resolution for which rounded times of unevenly spaced rows are reported: kCoarse times
/// the usual step, and kCoarse_ticks.
constexpr double kCoarse = 0.2;
constexpr std::int64_t kCoarse_ticks = 5000;
/// If all time steps are multiples of the usual step, and fewer than this fraction differ from it,
/// some rows are missing; the times are not rounded.
constexpr double kMissingRows = 0.2;

/// Rounding of the times of a file.
struct RoundedTimes {
  double resolution_s = 0.0;  ///< q: largest number of which all time steps are multiples
  double step_s = 0.0;        ///< h
  /// Estimated times without rounding; empty if the rows are not evenly spaced.
  std::vector<double> even_s;
};

std::vector<std::int64_t> steps_in_ticks(std::span<const double> t_s) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    steps.push_back(std::llround((t_s[i] - t_s[i - 1]) / kTick_s));
  }
  return steps;
}

std::int64_t median_of(std::vector<std::int64_t> steps) {
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Row numbers n_k: 0, 1, 2, ... plus the number of missing rows before each row. The step between
/// rows is the mean of all steps that differ from the median step by at most the resolution.
std::vector<double> numbers_with_missing_rows(const std::vector<std::int64_t>& steps,
                                              std::int64_t resolution) {
  const std::int64_t usual = median_of(steps);
  double sum = 0.0;
  double count = 0.0;
  for (const std::int64_t step : steps) {
    if (std::abs(step - usual) > resolution) continue;
    sum += static_cast<double>(step);
    count += 1.0;
  }
  std::vector<double> numbers{0.0};
  for (const std::int64_t step : steps) {
    numbers.push_back(numbers.back() +
                      std::max(1.0, std::round(static_cast<double>(step) * count / sum)));
  }
  return numbers;
}

/// Fits the line t_0 + n_k h to the times, s; h is the step between rows, q the resolution. Empty
/// if rounding does not explain the deviations from the line: a deviation exceeds q, or their
/// standard deviation exceeds q/sqrt(6). Rounding alone gives q/sqrt(12). At q/sqrt(6), the true
/// spacing varies as much as the rounding, and the rounded times are as good as the line.
std::optional<RoundedTimes> even_within(std::span<const double> t_s,
                                        const std::vector<double>& numbers, double resolution_s) {
  const EvenTimes even = even_times(t_s, numbers);
  RoundedTimes result{.resolution_s = resolution_s, .step_s = even.step_s, .even_s = {}};
  double squares = 0.0;
  double largest_s = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    result.even_s.push_back(even.at(numbers[i]));
    const double error_s = t_s[i] - result.even_s.back();
    squares += error_s * error_s;
    largest_s = std::max(largest_s, std::abs(error_s));
  }
  const bool is_rounding = largest_s <= resolution_s && squares / static_cast<double>(t_s.size()) <=
                                                            resolution_s * resolution_s / 6.0;
  return is_rounding ? std::optional(std::move(result)) : std::nullopt;
}

/// Finds rounded times. Empty if rounding does not matter: nearly all steps are equal, only rows
/// are missing, or the resolution is fine compared with the steps.
std::optional<RoundedTimes> check_rounding(std::span<const double> t_s) {
  if (t_s.size() < kMinRows) return std::nullopt;
  const std::vector<std::int64_t> steps = steps_in_ticks(t_s);
  std::int64_t resolution = 0;
  for (const std::int64_t step : steps) resolution = std::gcd(resolution, step);
  const std::int64_t usual = median_of(steps);
  const auto unequal = std::ranges::count_if(steps, [&](auto step) { return step != usual; });
  const double share = static_cast<double>(unequal) / static_cast<double>(steps.size());
  const double coarseness = static_cast<double>(resolution) / static_cast<double>(usual);
  const bool are_rows_missing = resolution == usual && share < kMissingRows;
  if (unequal < kMinUnequal || are_rows_missing || coarseness < kMatters) return std::nullopt;

  const double resolution_s = static_cast<double>(resolution) * kTick_s;
  std::vector<double> numbers(t_s.size());
  std::iota(numbers.begin(), numbers.end(), 0.0);
  if (auto even = even_within(t_s, numbers, resolution_s)) return even;
  if (resolution == usual) return std::nullopt;
  numbers = numbers_with_missing_rows(steps, resolution);
  if (auto even = even_within(t_s, numbers, resolution_s)) return even;
  if (coarseness < kCoarse || resolution < kCoarse_ticks) return std::nullopt;
  return RoundedTimes{.resolution_s = resolution_s, .step_s = 0.0, .even_s = {}};
}

}  // namespace

void replace_rounded_times(std::vector<double>& t_s, const std::string& file, int line,
                           std::vector<Finding>& findings) {
  std::optional<RoundedTimes> rounded = check_rounding(t_s);
  if (!rounded) return;
  if (rounded->even_s.empty()) {
    findings.push_back(
        {file, line, Severity::kWarning, "rounded-times",
         fmt::format("t_s has unequal steps that are multiples of {:g} s: the times are "
                     "probably rounded. The rows are not evenly spaced, so the times cannot be "
                     "corrected. The fit can mistake their errors for smoothing or latency of "
                     "the sensors; write the time with more digits",
                     rounded->resolution_s)});
    return;
  }
  findings.push_back(
      {file, line, Severity::kNote, "rounded-times",
       fmt::format("t_s is rounded to multiples of {:g} s; the rows are evenly spaced, {:.6g} s "
                   "apart, so times without rounding are used",
                   rounded->resolution_s, rounded->step_s)});
  t_s = std::move(rounded->even_s);
}

}  // namespace awmr
