#include "awmr/tune/sobol.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "awmr/core/random.h"

namespace awmr {
namespace {

constexpr int kResamples = 500;

struct FirstAndTotal {
  double first = 0.0, total = 0.0;
};

/// Sobol indices of one input, from the samples at `places`, which can repeat (bootstrap).
FirstAndTotal indices_over(const std::vector<std::size_t>& places, const std::vector<double>& of_a,
                           const std::vector<double>& of_b, const std::vector<double>& of_mixed) {
  double mean = 0.0, least = of_a[places.front()], most = least;
  for (const std::size_t j : places) {
    mean += of_a[j] + of_b[j];
    least = std::min({least, of_a[j], of_b[j]});
    most = std::max({most, of_a[j], of_b[j]});
  }
  // A constant output has the indices 0. Without this test, rounding of the mean would give it a
  // variance above 0.
  if (!(most > least)) return {};
  mean /= 2.0 * static_cast<double>(places.size());
  double squares = 0.0, without_first = 0.0, of_total = 0.0;
  for (const std::size_t j : places) {
    squares += (of_a[j] - mean) * (of_a[j] - mean) + (of_b[j] - mean) * (of_b[j] - mean);
    without_first += (of_b[j] - of_mixed[j]) * (of_b[j] - of_mixed[j]);
    of_total += (of_a[j] - of_mixed[j]) * (of_a[j] - of_mixed[j]);
  }
  // 2 N V = sum of the squares over both samples.
  return {1.0 - without_first / squares, of_total / squares};
}

Interval percentiles_95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return {values[static_cast<std::size_t>(std::floor(0.025 * last))],
          values[static_cast<std::size_t>(std::ceil(0.975 * last))]};
}

}  // namespace

std::vector<SobolIndex> sobol_indices(const std::vector<double>& of_a,
                                      const std::vector<double>& of_b,
                                      const std::vector<std::vector<double>>& of_mixed,
                                      std::uint64_t seed) {
  std::vector<std::size_t> places(of_a.size());
  std::iota(places.begin(), places.end(), 0);
  std::vector<SobolIndex> indices;
  for (const std::vector<double>& mixed : of_mixed) {
    const auto [first, total] = indices_over(places, of_a, of_b, mixed);
    indices.push_back({.first = first, .total = total, .first_ci95 = {}, .total_ci95 = {}});
  }
  std::vector<std::vector<double>> firsts(of_mixed.size()), totals(of_mixed.size());
  Random random(seed, 0);
  for (int resample = 0; resample < kResamples; ++resample) {
    for (std::size_t& place : places) {
      place = std::min(of_a.size() - 1, static_cast<std::size_t>(random.uniform() *
                                                                 static_cast<double>(of_a.size())));
    }
    for (std::size_t i = 0; i < of_mixed.size(); ++i) {
      const auto [first, total] = indices_over(places, of_a, of_b, of_mixed[i]);
      firsts[i].push_back(first);
      totals[i].push_back(total);
    }
  }
  for (std::size_t i = 0; i < of_mixed.size(); ++i) {
    indices[i].first_ci95 = percentiles_95(std::move(firsts[i]));
    indices[i].total_ci95 = percentiles_95(std::move(totals[i]));
  }
  return indices;
}

}  // namespace awmr
