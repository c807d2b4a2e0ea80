#include "awmr/identify/logs/simulation/smoothing_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/random.h"
#include "awmr/identify/logs/problem/channel_noise.h"

namespace awmr {
namespace {

double sum_of(const std::vector<double>& weights, int power) {
  double sum = power == 0 ? weights.front() : 0.0;
  for (std::size_t n = 1; n < weights.size(); ++n) {
    sum += 2.0 * std::pow(static_cast<double>(n), power) * weights[n];
  }
  return sum;
}

double weight_at(const SmoothingKernel& kernel, std::size_t n) {
  return n < kernel.weight.size() ? kernel.weight[n] : 0.0;
}

TEST(SmoothingKernel, HasSumOneAndTheGivenVariance) {
  for (const double variance :
       {0.0, 1e-9, 1e-3, 0.3, 2.0 / 3.0 - 1e-12, 2.0 / 3.0, 2.0, 7.1, 1e3}) {
    for (const SmoothingKernel& kernel : {gaussian_kernel(variance), moving_average(variance)}) {
      EXPECT_NEAR(sum_of(kernel.weight, 0), 1.0, 1e-12) << variance;
      EXPECT_NEAR(sum_of(kernel.weight, 2), variance, 1e-7 * (1.0 + variance)) << variance;
      // Tolerance: the kernel is cut off at six standard deviations; 2e-9 of the sum is lost.
      EXPECT_NEAR(sum_of(kernel.by_variance, 0), 0.0, 2e-9) << variance;
      EXPECT_NEAR(sum_of(kernel.by_variance, 2), 1.0, 1e-5) << variance;
    }
  }
}

TEST(SmoothingKernel, DerivativesAgreeWithDifferences) {
  constexpr double kStep = 1e-6;
  for (const double variance : {0.01, 0.5, 1.3, 4.7, 60.2}) {
    for (SmoothingKernel (*const kernel)(double) : {&gaussian_kernel, &moving_average}) {
      const SmoothingKernel here = kernel(variance);
      const SmoothingKernel more = kernel(variance + kStep);
      const SmoothingKernel less = kernel(variance - kStep);
      for (std::size_t n = 0; n < here.weight.size(); ++n) {
        const double difference = (weight_at(more, n) - weight_at(less, n)) / (2.0 * kStep);
        EXPECT_NEAR(here.by_variance[n], difference, 1e-7) << variance << " " << n;
      }
    }
  }
}

TEST(SmoothingKernel, IsBoundedForEveryVariance) {
  for (const double variance : {-1.0, std::numeric_limits<double>::quiet_NaN(), 1e300,
                                std::numeric_limits<double>::infinity()}) {
    for (const SmoothingKernel& kernel : {gaussian_kernel(variance), moving_average(variance)}) {
      EXPECT_LT(kernel.weight.size(), 1000U);
      EXPECT_NEAR(sum_of(kernel.weight, 0), 1.0, 1e-12);
    }
  }
}

/// -2 ln L of errors with the covariance matrix of differenced noise, up to a constant.
double dense_cost(const std::vector<double>& error, double std, double theta) {
  const Eigen::Index n = rows_of(error);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    covariance(i, i) = std * std * (1.0 + theta * theta);
    if (i > 0) covariance(i, i - 1) = covariance(i - 1, i) = -std * std * theta;
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::VectorXd e = Eigen::Map<const Eigen::VectorXd>(error.data(), n);
  const Eigen::MatrixXd l = factor.matrixL();
  return e.dot(factor.solve(e)) + 2.0 * l.diagonal().array().log().sum();
}

TEST(DifferencedNoise, HasTheLikelihoodOfItsCovarianceMatrix) {
  for (const double theta : {0.5, 0.9999}) {
    Random random(4, 2);
    ErrorSeries series;
    for (int k = 0; k < 20; ++k) {
      series.error.push_back(random.normal());
      series.since_s.push_back(k == 0 ? 0.0 : 0.02);
    }
    const ChannelNoise noise{.white_std = 0.7, .differenced = theta};
    EXPECT_NEAR(cost_of({&series, 1}, noise), dense_cost(series.error, 0.7, theta), 1e-9) << theta;
  }
}

// The noise before a gap in the log is independent of the noise after it.
TEST(DifferencedNoise, RestartsAfterAGap) {
  Random random(5, 2);
  ErrorSeries all;
  ErrorSeries before;
  ErrorSeries after;
  for (int k = 0; k < 20; ++k) {
    const double error = random.normal();
    all.error.push_back(error);
    all.since_s.push_back(k == 0 ? 0.0 : k == 12 ? 0.3 : 0.02);
    ErrorSeries& part = k < 12 ? before : after;
    part.since_s.push_back(part.error.empty() ? 0.0 : 0.02);
    part.error.push_back(error);
  }
  const ChannelNoise noise{.white_std = 0.7, .differenced = 0.8};
  EXPECT_NEAR(cost_of({&all, 1}, noise), cost_of({&before, 1}, noise) + cost_of({&after, 1}, noise),
              1e-9);
}

}  // namespace
}  // namespace awmr
