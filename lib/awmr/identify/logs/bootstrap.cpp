#include "awmr/identify/logs/bootstrap.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"
#include "awmr/core/random.h"
#include "awmr/core/sample_quantile.h"

namespace awmr {
namespace {

Eigen::VectorXd mean_of(const std::vector<Eigen::VectorXd>& scores, Eigen::Index n) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
  for (const Eigen::VectorXd& score : scores) mean += score / static_cast<double>(scores.size());
  return mean;
}

/// Sum of n scores drawn with replacement from the n scores, less n times their mean.
Eigen::VectorXd drawn_sum(const std::vector<Eigen::VectorXd>& scores, const Eigen::VectorXd& mean,
                          Random& random) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mean.size());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const double place = random.uniform() * static_cast<double>(scores.size());
    sum += scores[static_cast<std::size_t>(place)] - mean;
  }
  return sum;
}

/// Factor by which to scale the draws so that their standard deviation becomes `std`. The mean of
/// the draws is 0. Returns 1 if all draws are 0.
double scale_to(double std, const std::vector<double>& draws) {
  double squares = 0.0;
  for (const double draw : draws) squares += draw * draw;
  return squares > 0.0 ? std / std::sqrt(squares / static_cast<double>(draws.size())) : 1.0;
}

}  // namespace

std::vector<Interval> block_bootstrap(const BootstrapInput& input,
                                      const BootstrapOptions& options) {
  if (options.resamples <= 0) return {};
  const std::size_t n = input.quantities.size();
  std::vector<std::vector<double>> draws(n);  // draws[i]: change of coordinate i in each resample
  Random random(options.seed, 2);
  const Eigen::VectorXd mean = mean_of(input.scores, eigen_index(n));
  for (int b = 0; b < options.resamples; ++b) {
    const Eigen::VectorXd step = input.covariance * drawn_sum(input.scores, mean, random);
    for (std::size_t i = 0; i < n; ++i) draws[i].push_back(step(eigen_index(i)));
  }
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < n; ++i) {
    std::sort(draws[i].begin(), draws[i].end());
    const FreeQuantity& q = input.quantities[i];
    const double x = input.coordinates[i];
    const double std = std::sqrt(input.covariance(eigen_index(i), eigen_index(i)));
    const double scale = scale_to(std, draws[i]);
    intervals.push_back({q.value(x + scale * quantile_of_sorted(draws[i], 0.025)),
                         q.value(x + scale * quantile_of_sorted(draws[i], 0.975))});
  }
  return intervals;
}

}  // namespace awmr
