/// Intervals from tables for which it is unknown whether force, speed or time has the errors. They
/// are averaged over these noise models.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "awmr/identify/planning/recover.h"
#include "awmr/identify/uncertainty/posterior.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/trials/load.h"

namespace awmr::testing {
namespace {

std::string paper(const std::string& file) { return std::string(AWMR_SOURCE_DIR) + "/" + file; }

Model identified(const IdentifyOptions& options = {}) {
  const Vehicle vehicle = read_vehicle(paper("configs/paper/vehicle.json")).value();
  const Trials trials =
      load_trials(vehicle, {.surge = paper("datasets/paper/surge.csv"),
                            .turning = paper("datasets/paper/turning.csv"),
                            .coastdowns = {paper("datasets/paper/coastdown.csv")}})
          .value();
  return identify(trials, options).value().model;
}

double posterior_weight(const Model& model, FitSubject subject) {
  double sum = 0.0;
  for (const EstimatorReport& report : model.record.reports) {
    if (report.subject == subject) sum += report.weight.value_or(0.0);
  }
  return sum;
}

TEST(NoiseAverage, KeepsThePapersValuesAndCoversTheOtherEstimators) {
  const Model model = identified();
  const Estimate& mass = model[ParameterId::kMassNorm];
  // Golden values: the log-linear values of README.md, and quantiles of the mixture computed by
  // SciPy (Student's t, Brent's method). Tolerance: rounding to the digits given here.
  EXPECT_NEAR(*model[ParameterId::kSurgeAlpha].value, 1.3157, 5e-5);
  EXPECT_NEAR(*model[ParameterId::kSurgeBeta].value, 0.8841, 5e-5);
  EXPECT_NEAR(*mass.value, 0.0824, 5e-5);
  EXPECT_NEAR(*model[ParameterId::kInertiaNorm].value, 0.0130, 5e-5);
  ASSERT_TRUE(mass.quantiles);
  const double expected[] = {0.0693, 0.0950, 0.1096, 0.1210, 0.1466};
  for (std::size_t q = 0; q < kQuantileCount; ++q) {
    EXPECT_NEAR((*mass.quantiles)[q], expected[q], 1e-4) << kQuantiles[q].key;
  }
  // The interval contains the values of m' from equation (60) and Table 2, fitted with errors on
  // the force (0.1117) and with errors on the speed (0.1168).
  EXPECT_TRUE(mass.ci95->contains(0.1117));
  EXPECT_TRUE(mass.ci95->contains(0.1168));
  for (const FitSubject subject : {FitSubject::kSurge, FitSubject::kYaw, FitSubject::kMass}) {
    EXPECT_NEAR(posterior_weight(model, subject), 1.0, 1e-12);
  }
}

TEST(NoiseAverage, InertiaInheritsTheMassesQuantiles) {
  const Model model = identified();
  const double factor = model.vehicle.inertia_kgm2() / model.vehicle.mass_kg;
  for (std::size_t q = 0; q < kQuantileCount; ++q) {
    // Tolerance: the same product is computed in another order, with a few rounding errors.
    EXPECT_NEAR((*model[ParameterId::kInertiaNorm].quantiles)[q] /
                    (factor * (*model[ParameterId::kMassNorm].quantiles)[q]),
                1.0, 1e-13);
  }
}

TEST(NoiseAverage, KeepsTheErrorLocationIfAFamilyIsRequested) {
  IdentifyOptions options;
  options.surge_family = {std::nullopt, true};
  options.yaw_family = {std::nullopt, true};
  const Model model = identified(options);
  const Model plain = identified();
  for (const ParameterId id :
       {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta, ParameterId::kYawAlpha,
        ParameterId::kYawBeta, ParameterId::kMassNorm}) {
    // Tolerance: Ceres and QR both end within 1e-6 of the least-squares solution.
    EXPECT_NEAR(*model[id].value / *plain[id].value, 1.0, 1e-6) << info(id).name;
  }
}

TEST(NoiseAverage, UsesOnlyTheRequestedErrorModel) {
  IdentifyOptions options;
  options.method = Method::kNonlinear;
  options.noise = ErrorModel::kForce;
  EXPECT_EQ(posterior_weight(identified(options), FitSubject::kSurge), 0.0);
}

TEST(NoiseAverage, ReportsTheGripMassNextToAnImplausibleOne) {
  const Model model = identified();
  // m' for which the deceleration g1(u)/m' at u = 1.66 m/s is that of a tyre friction of 0.8
  const double expected = 1.31567 * std::pow(1.66, 0.884123) / (0.8 * 9.80665);
  ASSERT_TRUE(model.mass_norm_by_grip);
  EXPECT_NEAR(*model.mass_norm_by_grip / expected, 1.0, 1e-4);
}

/// The measured coverage of 150 tables has a standard deviation of sqrt(0.95 0.05/150) = 1.8 %, so
/// at least 95 % - 3 * 1.8 % = 89.6 % are required. scripts/coverage uses 1,000 tables.
TEST(NoiseAverage, MassIntervalCoversTheTruthForEveryErrorLocation) {
  const Model model = identified();
  for (const ErrorModel error : {ErrorModel::kTime, ErrorModel::kSpeed, ErrorModel::kForce}) {
    RecoverOptions options;
    options.runs = 150;
    options.error = error;
    const Recovery recovery = recover(model, options, [](int) {}).value();
    const auto mass =
        std::ranges::find(recovery.parameters, ParameterId::kMassNorm, &RecoveredParameter::id);
    EXPECT_GE(mass->coverage95, 0.896) << name_of(error);
  }
}

TEST(Posterior, QuantilesOfOneAlternativeAreStudents) {
  const Posterior one{{{1.0, Eigen::VectorXd::Constant(1, 2.0),
                        Eigen::MatrixXd::Constant(1, 1, 9.0), Eigen::VectorXd::Constant(1, 8.0)}}};
  // The 97.5 % quantile of Student's t with 8 degrees of freedom is 2.306004 (R, qt).
  EXPECT_NEAR(one.quantile(0, 0.975), 2.0 + 3.0 * 2.306004, 3e-6);
  EXPECT_NEAR(one.quantile(0, 0.5), 2.0, 1e-12);
}

TEST(Posterior, WithoutDegreesOfFreedomTheErrorIsInfiniteAndThereIsNoInterval) {
  const Posterior one{{{1.0, Eigen::VectorXd::Constant(1, 2.0),
                        Eigen::MatrixXd::Constant(1, 1, 9.0), Eigen::VectorXd::Constant(1, NAN)}}};
  Estimate estimate;
  estimate.value = 2.0;
  set_uncertainty(
      one, 0, 1.0, [](double x) { return x; }, estimate);
  EXPECT_TRUE(std::isinf(*estimate.std_error));
  EXPECT_FALSE(estimate.ci95);
  EXPECT_FALSE(estimate.quantiles);
}

TEST(Posterior, MixtureOfTwoFarApartHasTheMediansOfHalves) {
  const auto at = [](double weight, double centre) {
    return Posterior::Alternative{weight, Eigen::VectorXd::Constant(1, centre),
                                  Eigen::MatrixXd::Constant(1, 1, 1e-4),
                                  Eigen::VectorXd::Constant(1, 1e9)};
  };
  const Posterior two{{at(0.5, 0.0), at(0.5, 10.0)}};
  // Two equally likely normal distributions at 0 and 10, 1000 standard deviations apart: a quarter
  // of the probability is below the centre of the first.
  EXPECT_NEAR(two.quantile(0, 0.25), 0.0, 1e-9);
  EXPECT_NEAR(two.quantile(0, 0.75), 10.0, 1e-9);
  EXPECT_NEAR(two.covariance()(0, 0), 25.0 + 1e-4, 1e-9);
}

}  // namespace
}  // namespace awmr::testing
