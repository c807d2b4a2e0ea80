#include "awmr/identify/logs/family_score.h"

#include <cmath>
#include <limits>

namespace awmr {
namespace {

/// Size of a fit's errors, to compare two fits: the sum of n ln(sum e^2/n) over all channels, with
/// the n errors e of a channel.
double log_size_of_errors(const LogFit& fit) {
  double size = 0.0;
  for (const auto& [channel, errors] : fit.errors) {
    double squares = 0.0;
    double n = 0.0;
    for (const ErrorSeries& part : errors) {
      for (const double e : part.error) squares += e * e;
      n += static_cast<double>(part.error.size());
    }
    size += n * std::log(std::max(squares / n, kMinimumStd * kMinimumStd));
  }
  return size;
}

/// Noise model of the fit with the smaller errors.
const NoiseLevels& noise_of_better(const LogFit& a, const LogFit& b) {
  return log_size_of_errors(a) <= log_size_of_errors(b) ? a.noise : b.noise;
}

}  // namespace

double aic_under(const NoiseLevels& noise, const LogFit& fit) {
  double aic = 2.0 * static_cast<double>(fit.quantities.size()) + fit.change_cost;
  for (const auto& [channel, errors] : fit.errors) aic += cost_of(errors, noise.at(channel));
  return aic;
}

double aic_lead(const LogFit& a, const LogFit& b) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!a.usable || !b.usable) return a.usable ? kInfinity : b.usable ? -kInfinity : 0.0;
  const NoiseLevels& noise = noise_of_better(a, b);
  return aic_under(noise, b) - aic_under(noise, a);
}

double aic_lead_of_most_rows(const LogFit& a, const LogFit& b) {
  constexpr double kMost = 9.0;
  if (!a.usable || !b.usable) return aic_lead(a, b);
  const NoiseLevels& noise = noise_of_better(a, b);
  const auto aic = [&](const LogFit& fit) {
    double sum = 2.0 * static_cast<double>(fit.quantities.size()) + fit.change_cost;
    for (const auto& [channel, errors] : fit.errors) {
      sum += clipped_cost_of(errors, noise.at(channel), kMost);
    }
    return sum;
  };
  return aic(b) - aic(a);
}

}  // namespace awmr
