/// Fit of a power law compared with certified values: data set DanWood of NIST StRD (nonlinear
/// regression), y = b1 x^b2, certified to eleven digits.
#include <gtest/gtest.h>

#include "awmr/identify/identify.h"

namespace awmr::testing {
namespace {

/// The data set as surge runs: x is the speed and y the force tau_speed, scaled by 0.1 so that it
/// stays below 4.
TrialData danwood() {
  constexpr double kY[] = {2.138, 3.421, 3.597, 4.340, 4.882, 5.660};
  constexpr double kX[] = {1.309, 1.471, 1.490, 1.565, 1.611, 1.680};
  TrialSet<SurgeRow> surge{"DanWood", {}, 0};
  for (int i = 0; i < 6; ++i) surge.rows.push_back({i + 2, 0.1 * kY[i], kX[i], {}, {}});
  return {surge, {}, {}};
}

TEST(DanWood, ParametersAndStandardDeviationsAgreeToSixDigits) {
  Vehicle vehicle{};
  vehicle.mass_kg = vehicle.length_m = vehicle.width_m = 1.0;
  vehicle.surge_beta_range = {0.0, 10.0};
  IdentifyOptions options;
  options.method = Method::kNonlinear;
  options.noise = ErrorModel::kForce;
  const auto result = identify(vehicle, danwood(), options, {});
  ASSERT_TRUE(result);
  const Estimate& alpha = result->model[ParameterId::kSurgeAlpha];
  const Estimate& beta = result->model[ParameterId::kSurgeBeta];
  // Certified values. alpha and its standard deviation are scaled by the force's factor 0.1. Six
  // digits are required: 1e-6 relative.
  EXPECT_NEAR(*alpha.value, 0.1 * 7.6886226176e-01, 1e-6 * 0.0769);
  EXPECT_NEAR(*alpha.std_error, 0.1 * 1.8281973860e-02, 1e-6 * 0.00183);
  EXPECT_NEAR(*beta.value, 3.8604055871e+00, 1e-6 * 3.86);
  EXPECT_NEAR(*beta.std_error, 5.1726610913e-02, 1e-6 * 0.0517);
  // Certified residual standard deviation 3.2853114039e-02.
  for (const EstimatorReport& report : result->model.record.reports) {
    if (report.noise == name_of(ErrorModel::kForce) && report.family == "power") {
      EXPECT_NEAR(report.residual_std, 0.1 * 3.2853114039e-02, 1e-6 * 0.0033);
      EXPECT_EQ(report.degrees_of_freedom, 4);
      EXPECT_EQ(report.rank, 2);
    }
  }
}

}  // namespace
}  // namespace awmr::testing
