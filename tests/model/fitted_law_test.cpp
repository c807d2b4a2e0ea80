/// Resistance law fitted to a model's trials, and its uncertainty, compared with finite
/// differences.
#include "awmr/model/fitted_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "awmr/core/units.h"

namespace awmr::testing {
namespace {

/// A yaw law with four terms, all uncertain, and a surge law.
Model model_of_laws() {
  Model model;
  model[ParameterId::kYawAlpha].value = 0.3;
  model[ParameterId::kYawBeta].value = 0.8;
  model[ParameterId::kYawCoulomb].value = 0.01;
  model[ParameterId::kYawQuadratic].value = 0.05;
  model[ParameterId::kSurgeAlpha].value = 1.3;
  model[ParameterId::kSurgeBeta].value = 0.9;
  model[ParameterId::kWheelDeadZone].value = 0.02;
  model.covariance.parameters = {ParameterId::kSurgeAlpha,   ParameterId::kYawBeta,
                                 ParameterId::kYawAlpha,     ParameterId::kYawCoulomb,
                                 ParameterId::kYawQuadratic, ParameterId::kWheelDeadZone};
  // The product L L' of a lower triangular matrix L and its transpose is a valid covariance.
  const std::size_t n = model.covariance.parameters.size();
  std::vector<std::vector<double>> lower(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) lower[i][j] = 0.01 * std::cos(1.0 + double(3 * i + j));
  }
  model.covariance.matrix.assign(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        model.covariance.matrix[i][j] += lower[i][k] * lower[j][k];
      }
    }
  }
  return model;
}

/// Mean of the law over the rates. For surge trials, it includes the dead zones of the driven
/// wheels.
double mean_of_law(const Model& model, TrialKind kind, const std::vector<double>& rates) {
  double sum = 0.0;
  for (const double rate : rates) sum += fitted_law(model, kind)->at(rate);
  const double zone = kind == TrialKind::kTurning ? 0.0
                                                  : model.vehicle.driven_wheels() *
                                                        *model[ParameterId::kWheelDeadZone].value;
  return sum / static_cast<double>(rates.size()) + zone;
}

TEST(FittedLaw, HasTheVarianceByFiniteDifferences) {
  const Model model = model_of_laws();
  const std::vector<double> rates{0.1, 0.3, 0.9};
  for (const TrialKind kind : {TrialKind::kTurning, TrialKind::kSurge}) {
    std::vector<double> slopes;
    for (const ParameterId parameter : model.covariance.parameters) {
      constexpr double kStep = 1e-6;
      Model more = model, less = model;
      *more[parameter].value += kStep;
      *less[parameter].value -= kStep;
      slopes.push_back((mean_of_law(more, kind, rates) - mean_of_law(less, kind, rates)) /
                       (2.0 * kStep));
    }
    double expected = 0.0;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      for (std::size_t j = 0; j < slopes.size(); ++j) {
        expected += slopes[i] * model.covariance.matrix[i][j] * slopes[j];
      }
    }
    EXPECT_GT(expected, 0.0);
    EXPECT_NEAR(variance_of_law(model, kind, rates), expected, 1e-8 * expected);
  }
}

TEST(FittedLaw, IsAbsentWithoutItsPower) {
  Model model = model_of_laws();
  model[ParameterId::kYawBeta].value.reset();
  EXPECT_FALSE(fitted_law(model, TrialKind::kTurning));
  EXPECT_TRUE(fitted_law(model, TrialKind::kSurge));
}

TEST(FittedLaw, IsMeasuredUpToTheFastestTurnOfTablesAndLogs) {
  Model model = model_of_laws();
  EXPECT_FALSE(measured_yaw_rate_degps(model));
  TrialPoint turn;
  turn.kind = TrialKind::kTurning;
  turn.measured = radians(15.0);
  model.record.trials = {turn};
  EXPECT_NEAR(*measured_yaw_rate_degps(model), 15.0, 1e-12);
  model.record.logged_yaw_rate_radps = radians(40.0);
  EXPECT_NEAR(*measured_yaw_rate_degps(model), 40.0, 1e-12);
  model.record.logged_yaw_rate_radps = radians(10.0);
  EXPECT_NEAR(*measured_yaw_rate_degps(model), 15.0, 1e-12);
  model.vehicle.yaw_rate_max_degps = 8.0;  // the manufacturer's value has precedence
  EXPECT_EQ(*measured_yaw_rate_degps(model), 8.0);
}

}  // namespace
}  // namespace awmr::testing
