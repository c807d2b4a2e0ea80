#include "awmr/simulate/plant_sampler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

constexpr int kDraws = 20000;

/// Sampled coordinates: logarithms of a1, a3 and m'; b1 itself.
std::array<double, 4> coordinates(const Plant<double>& plant) {
  return {std::log(plant.surge.alpha), plant.surge.beta, std::log(plant.yaw.alpha),
          std::log(plant.mass_norm)};
}

std::vector<std::array<double, 4>> drawn(const PlantSampler& sampler) {
  std::vector<std::array<double, 4>> draws;
  for (int sample = 1; sample <= kDraws; ++sample) {
    draws.push_back(coordinates(*sampler.draw(7, sample)));
  }
  return draws;
}

TEST(PlantSampler, DrawsHaveTheModelsMeanAndCovariance) {
  const Model model = uncertain_model();
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  const auto draws = drawn(*sampler);
  const std::array<double, 4> centre = coordinates(*model.plant());
  const std::array<double, 4> scale = {1.3157, 1.0, 0.3028, 0.0768};
  std::array<double, 4> mean{};
  for (const auto& z : draws) {
    for (std::size_t i = 0; i < 4; ++i) mean[i] += z[i] / kDraws;
  }
  const auto expected = [&](std::size_t i, std::size_t j) {
    return model.covariance.matrix[i][j] / (scale[i] * scale[j]);
  };
  for (std::size_t i = 0; i < 4; ++i) {
    // Standard error of a mean sigma/sqrt(n); five of them are exceeded once in 10^6 seeds.
    EXPECT_NEAR(mean[i], centre[i], 5.0 * std::sqrt(expected(i, i) / kDraws)) << i;
    for (std::size_t j = 0; j < 4; ++j) {
      double covariance = 0.0;
      for (const auto& z : draws) {
        covariance += (z[i] - mean[i]) * (z[j] - mean[j]) / (kDraws - 1);
      }
      // The sample covariance s_ij of normal draws has the variance (C_ii C_jj + C_ij^2)/(n - 1).
      const double deviation =
          std::sqrt((expected(i, i) * expected(j, j) + expected(i, j) * expected(i, j)) / kDraws);
      EXPECT_NEAR(covariance, expected(i, j), 5.0 * deviation) << i << ' ' << j;
    }
  }
}

/// With 32 independent draws, the standard errors would be sigma/sqrt(32) = 0.18 sigma for the
/// mean, sqrt(2/32) = 0.25 for the mean square, and 0.11 for the mean square over five seeds. The
/// mean of the stratified draws must be accurate to a third of 0.18, their mean square over the
/// seeds to twice 0.11.
TEST(PlantSampler, EvenDrawsHaveTheModelsMeanAndSpreadWhileTheyAreFew) {
  constexpr int kFew = 32;
  constexpr int kSeeds = 5;
  const Model model = uncertain_model();
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  const std::array<double, 4> centre = coordinates(*model.plant());
  const std::array<double, 4> scale = {1.3157, 1.0, 0.3028, 0.0768};
  for (std::size_t i = 0; i < 4; ++i) {
    const double sigma = std::sqrt(model.covariance.matrix[i][i]) / scale[i];
    double square = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      double mean = 0.0;
      const std::vector<Plant<double>> plants = sampler->draw_evenly(seed, kFew).value();
      for (const Plant<double>& plant : plants) {
        const double z = (coordinates(plant)[i] - centre[i]) / sigma;
        mean += z / kFew;
        square += z * z / (kFew * kSeeds);
      }
      EXPECT_LT(std::abs(mean), 0.06) << seed << ' ' << i;
    }
    EXPECT_NEAR(square, 1.0, 0.22) << i;
  }
}

/// The share below a quantile of n draws has a standard deviation of sqrt(p (1 - p)/n); Five of
/// them are exceeded once in 10^6 seeds.
TEST(PlantSampler, DrawsHaveTheQuantilesThatTheModelShows) {
  Model model = uncertain_model();
  const Quantiles shown{0.06, 0.08, 0.11, 0.12, 0.15};
  model[ParameterId::kMassNorm].quantiles = shown;
  const auto draws = drawn(PlantSampler::make(model).value());
  for (std::size_t q = 0; q < kQuantileCount; ++q) {
    const double p = kQuantiles[q].probability;
    const auto below = std::count_if(draws.begin(), draws.end(),
                                     [&](const auto& z) { return z[3] < std::log(shown[q]); });
    EXPECT_NEAR(static_cast<double>(below) / kDraws, p, 5.0 * std::sqrt(p * (1.0 - p) / kDraws));
  }
}

TEST(PlantSampler, AQuarterOfTheDrawsHasTheMassThatTheGripRequires) {
  Model model = uncertain_model();
  model.mass_norm_by_grip = 0.26;
  const double ratio =
      *model[ParameterId::kInertiaNorm].value / *model[ParameterId::kMassNorm].value;
  const auto sampler = PlantSampler::make(model).value();
  const std::vector<Plant<double>> plants = sampler.draw_evenly(3, 32).value();
  int gripped = 0;
  for (const Plant<double>& plant : plants) {
    if (plant.mass_norm < 0.26) continue;
    ++gripped;
    // m' is drawn. I'z is not drawn, but scaled with the mass that the grip requires.
    EXPECT_GT(plant.inertia_norm, 0.26 * ratio * 0.5);
  }
  EXPECT_EQ(gripped, 8);
}

TEST(PlantSampler, PlantsAtGivenNormalsDoNotHaveTheMassThatTheGripRequires) {
  const Model bare = uncertain_model();
  Model model = bare;
  model.mass_norm_by_grip = 0.26;
  const auto sampler = PlantSampler::make(model).value();
  const auto without = PlantSampler::make(bare).value();
  const std::size_t count = model.covariance.parameters.size();
  for (const double normal : {-2.0, -0.7, 0.0, 1.0}) {
    const std::vector<double> normals(count, normal);
    EXPECT_EQ(sampler.plant_at(normals)->mass_norm, without.plant_at(normals)->mass_norm);
    EXPECT_EQ(sampler.plant_at(normals)->inertia_norm, without.plant_at(normals)->inertia_norm);
  }
}

TEST(PlantSampler, KeepsParametersOutsideTheCovariance) {
  const Model model = uncertain_model();
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  const auto plant = sampler->draw(1, 1);
  ASSERT_TRUE(plant);
  EXPECT_EQ(plant->yaw.beta, 0.8250);
  EXPECT_EQ(plant->inertia_norm, 0.01212);
  EXPECT_EQ(plant->sway_alpha, 3.0);
  EXPECT_NE(plant->surge.alpha, 1.3157);
  EXPECT_NE(plant->mass_norm, 0.0768);
}

TEST(PlantSampler, ADrawDependsOnSeedAndSampleAlone) {
  const auto sampler = PlantSampler::make(uncertain_model());
  ASSERT_TRUE(sampler);
  const auto first = coordinates(*sampler->draw(1, 5));
  EXPECT_EQ(first, coordinates(*sampler->draw(1, 5)));
  EXPECT_NE(first, coordinates(*sampler->draw(1, 6)));
  EXPECT_NE(first, coordinates(*sampler->draw(2, 5)));
}

TEST(PlantSampler, KeepsPositiveQuantitiesPositiveWhateverTheirError) {
  Model model = fitted_paper_model();
  model.covariance.parameters = {ParameterId::kMassNorm};
  model.covariance.matrix = {{4.0 * 0.0768 * 0.0768}};  // s.e. of 200 %
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  for (int sample = 1; sample <= 1000; ++sample) {
    EXPECT_GT(sampler->draw(1, sample)->mass_norm, 0.0);
  }
}

/// surge_beta_range limits fits, not draws, because an estimate at an end of the range is uncertain
/// in both directions.
TEST(PlantSampler, DrawsExponentsOnBothSidesOfAnEndOfTheVehiclesRange) {
  for (const double beta : {0.995, 1.0, 1.4}) {
    Model model = uncertain_model();
    ASSERT_EQ(model.vehicle.surge_beta_range.hi, 1.0);
    model[ParameterId::kSurgeBeta].value = beta;
    const auto sampler = PlantSampler::make(model);
    ASSERT_TRUE(sampler);
    int above = 0;
    for (int sample = 1; sample <= 1000; ++sample) {
      const auto plant = sampler->draw(1, sample);
      ASSERT_TRUE(plant) << to_text(plant.error());
      above += plant->surge.beta > beta ? 1 : 0;
    }
    // The count is binomial with n = 1000 and p = 1/2, so its standard deviation is 16. Tolerance:
    // 5 standard deviations.
    EXPECT_NEAR(above, 500, 79) << beta;
  }
}

TEST(PlantSampler, DrawsNoNegativeExponent) {
  Model model = uncertain_model();
  model[ParameterId::kSurgeBeta].value = 0.01;  // s.e. 0.016: a quarter of normal draws are below 0
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  for (int sample = 1; sample <= 1000; ++sample) {
    EXPECT_GE(sampler->draw(1, sample)->surge.beta, 0.0);
  }
}

/// The estimate of an optional term can be exactly 0. Draws below 0 are repeated, so the draws have
/// a half-normal distribution: mean sigma sqrt(2/pi), variance sigma^2 (1 - 2/pi).
TEST(PlantSampler, DrawsATermFittedAsZeroFromTheHalfOfItsNormalAboveZero) {
  constexpr double kSigma = 0.02;
  Model model = fitted_paper_model();
  model.surge_family = Family::kCoulombPower;
  model[ParameterId::kSurgeCoulomb] = {0.0, kSigma, Interval{0.0, 0.04}, Source::kFitted, ""};
  model.covariance.parameters = {ParameterId::kSurgeAlpha, ParameterId::kSurgeCoulomb};
  model.covariance.matrix = {{4e-4, 0.0}, {0.0, kSigma * kSigma}};
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  double mean = 0.0;
  for (int sample = 1; sample <= kDraws; ++sample) {
    const auto plant = sampler->draw(7, sample);
    ASSERT_TRUE(plant);
    ASSERT_TRUE(std::isfinite(plant->surge.alpha));
    ASSERT_TRUE(std::isfinite(plant->surge.coulomb));
    ASSERT_GE(plant->surge.coulomb, 0.0);
    mean += plant->surge.coulomb / kDraws;
  }
  const double half = 2.0 / std::acos(-1.0);
  EXPECT_NEAR(mean, kSigma * std::sqrt(half), 5.0 * kSigma * std::sqrt((1.0 - half) / kDraws));
}

TEST(PlantSampler, DrawsATermWellAboveZeroAsTheNormalThatItsFitGave) {
  constexpr double kSigma = 0.02;
  constexpr double kValue = 0.2;  // ten standard errors from 0: none is redrawn
  Model model = fitted_paper_model();
  model.surge_family = Family::kDeadZone;
  model[ParameterId::kWheelDeadZone] = {kValue, kSigma, Interval{0.16, 0.24}, Source::kFitted, ""};
  model.covariance.parameters = {ParameterId::kWheelDeadZone};
  model.covariance.matrix = {{kSigma * kSigma}};
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  double mean = 0.0;
  double squares = 0.0;
  for (int sample = 1; sample <= kDraws; ++sample) {
    const double z = (sampler->draw(7, sample)->wheel_dead_zone - kValue) / kSigma;
    mean += z / kDraws;
    squares += z * z / kDraws;
  }
  // Standard normal numbers: the mean errs by 1/sqrt(n), the mean square by sqrt(2/n).
  EXPECT_NEAR(mean, 0.0, 5.0 / std::sqrt(kDraws));
  EXPECT_NEAR(squares, 1.0, 5.0 * std::sqrt(2.0 / kDraws));
}

TEST(PlantSampler, RefusesIfNearlyNoDrawIsAdmissible) {
  Model model = uncertain_model();
  model[ParameterId::kSurgeBeta].value = -1.0;  // 60 standard errors below 0
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  const auto plant = sampler->draw(1, 1);
  ASSERT_FALSE(plant);
  EXPECT_EQ(plant.error().kind, ErrorKind::kInput);
  EXPECT_EQ(plant.error().faults.front().place, "model.json:/covariance");
}

TEST(PlantSampler, DrawsFromASingularCovariance) {
  // m' computed from a1 alone, m' = c a1: correlation 1, so the drawn ratio is constant.
  Model model = fitted_paper_model();
  const double c = 0.0768 / 1.3157;
  model.covariance.parameters = {ParameterId::kSurgeAlpha, ParameterId::kMassNorm};
  model.covariance.matrix = {{4e-4, 4e-4 * c}, {4e-4 * c, 4e-4 * c * c}};
  const auto sampler = PlantSampler::make(model);
  ASSERT_TRUE(sampler);
  for (int sample = 1; sample <= 100; ++sample) {
    const auto plant = sampler->draw(1, sample);
    // By rounding, the eigenvalue 0 becomes up to 1e-16 of 5e-4. Its square root, 2e-10, is
    // multiplied by normals up to 5.
    EXPECT_NEAR(std::log(plant->mass_norm / plant->surge.alpha), std::log(c), 1e-8);
  }
}

TEST(PlantSampler, RefusesAMatrixThatIsNotACovariance) {
  Model none = fitted_paper_model();
  Model indefinite = uncertain_model();
  indefinite.covariance.matrix[0][1] = indefinite.covariance.matrix[1][0] = 1.0;
  Model ragged = uncertain_model();
  ragged.covariance.matrix.pop_back();
  Model not_a_number = uncertain_model();
  not_a_number.covariance.matrix[2][2] = std::nan("");
  for (const Model& model : {none, indefinite, ragged, not_a_number}) {
    const auto sampler = PlantSampler::make(model);
    ASSERT_FALSE(sampler);
    EXPECT_EQ(sampler.error().kind, ErrorKind::kInput);
    EXPECT_THAT(to_text(sampler.error()), HasSubstr("model.json:/covariance"));
  }
}

}  // namespace
}  // namespace awmr::testing
