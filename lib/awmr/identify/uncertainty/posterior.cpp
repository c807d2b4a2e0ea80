#include "awmr/identify/uncertainty/posterior.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "awmr/core/index.h"
#include "awmr/core/statistics/distributions.h"

namespace awmr {
namespace {

double scale_of(const Posterior::Alternative& alternative, Eigen::Index i) {
  return std::sqrt(alternative.covariance(i, i));
}

/// Probability that number i is at most x. A number with variance 0 is known exactly.
double probability_below(const Posterior& posterior, Eigen::Index i, double x) {
  double sum = 0.0;
  for (const Posterior::Alternative& alternative : posterior.alternatives) {
    const double scale = scale_of(alternative, i);
    const double distance = x - alternative.centre(i);
    const double below = scale > 0.0 ? students_t_tail(-distance / scale, alternative.dof(i))
                                     : (distance >= 0.0 ? 1.0 : 0.0);
    sum += alternative.weight * below;
  }
  return sum;
}

}  // namespace

bool Posterior::is_proper(Eigen::Index i) const {
  return std::ranges::all_of(alternatives, [i](const Alternative& k) {
    const double variance = k.covariance(i, i);
    return std::isfinite(k.centre(i)) && std::isfinite(variance) && variance >= 0.0 &&
           k.dof(i) > 0.0;
  });
}

Eigen::MatrixXd Posterior::covariance() const {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(alternatives.front().centre.size());
  for (const Alternative& k : alternatives) mean += k.weight * k.centre;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(mean.size(), mean.size());
  for (const Alternative& k : alternatives) {
    const Eigen::VectorXd d = k.centre - mean;
    sum += k.weight * (k.covariance + d * d.transpose());
  }
  return sum;
}

double Posterior::quantile(Eigen::Index i, double p) const {
  // The quantile of a mixture is between the smallest and the largest of its alternatives'
  // quantiles.
  Interval bracket;
  for (const Alternative& k : alternatives) {
    const double own = k.centre(i) + scale_of(k, i) * students_t_quantile(p, k.dof(i));
    const bool is_first = &k == &alternatives.front();
    bracket = is_first ? Interval{own, own}
                       : Interval{std::min(bracket.lo, own), std::max(bracket.hi, own)};
  }
  if (!(bracket.lo < bracket.hi)) return bracket.lo;
  const auto excess = [&](double x) { return probability_below(*this, i, x) - p; };
  const double at_low = excess(bracket.lo);
  const double at_high = excess(bracket.hi);
  if (!(at_low < 0.0)) return bracket.lo;
  if (!(at_high > 0.0)) return bracket.hi;
  constexpr int kBits = std::numeric_limits<double>::digits - 2;
  std::uintmax_t evaluations = 100;
  const auto [low, high] = boost::math::tools::toms748_solve(
      excess, bracket.lo, bracket.hi, at_low, at_high,
      boost::math::tools::eps_tolerance<double>(kBits), evaluations);
  return 0.5 * (low + high);
}

void set_uncertainty(const Posterior& posterior, Eigen::Index i, double slope,
                     const std::function<double(double)>& to_value, Estimate& estimate) {
  if (posterior.empty()) return;
  if (!posterior.is_proper(i)) {
    estimate.std_error = std::numeric_limits<double>::infinity();
    return;
  }
  estimate.std_error = slope * std::sqrt(posterior.covariance()(i, i));
  Quantiles quantiles{};
  for (std::size_t q = 0; q < kQuantiles.size(); ++q) {
    quantiles[q] = to_value(posterior.quantile(i, kQuantiles[q].probability));
  }
  // The reported value is between these quantiles, because the alternative that it comes from has
  // at least the weight kMinOwnWeight. min() and max() only correct rounding errors.
  estimate.ci95 = Interval{std::min(quantiles.front(), *estimate.value),
                           std::max(quantiles.back(), *estimate.value)};
  estimate.quantiles = quantiles;
}

}  // namespace awmr
