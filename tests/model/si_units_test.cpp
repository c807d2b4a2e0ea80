/// The model in newtons and kilograms: values by hand, covariance by logarithms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "awmr/model/model_file.h"
#include "awmr/model/si_units.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SiQuantity quantity(const Model& model, const std::string& pointer) {
  for (const SiQuantity& q : si_quantities(model)) {
    if (q.pointer == pointer) return q;
  }
  ADD_FAILURE() << "no " << pointer;
  return {};
}

/// Standard errors of 5 % of a1 and 10 % of m', correlation of their logarithms -0.6, and intervals
/// of two standard errors of a logarithm; I'z = m' Iz/m.
Model uncertain_model() {
  Model model = fitted_paper_model();
  const double a = *model[ParameterId::kSurgeAlpha].value;
  const double m = *model[ParameterId::kMassNorm].value;
  const double factor = model.vehicle.inertia_kgm2() / model.vehicle.mass_kg;
  model[ParameterId::kInertiaNorm].value = factor * m;
  for (const auto& [id, share] :
       {std::pair{ParameterId::kSurgeAlpha, 0.05}, std::pair{ParameterId::kMassNorm, 0.1},
        std::pair{ParameterId::kInertiaNorm, 0.1}}) {
    Estimate& e = model[id];
    e.std_error = share * *e.value;
    e.ci95 = Interval{*e.value * std::exp(-2.0 * share), *e.value * std::exp(2.0 * share)};
    e.source = Source::kFitted;
  }
  const double aa = 0.05 * 0.05 * a * a;
  const double am = -0.6 * 0.05 * 0.1 * a * m;
  const double mm = 0.1 * 0.1 * m * m;
  model.covariance = {{ParameterId::kSurgeAlpha, ParameterId::kMassNorm, ParameterId::kInertiaNorm},
                      {{aa, am, factor * am},
                       {am, mm, factor * mm},
                       {factor * am, factor * mm, factor * factor * mm}}};
  return model;
}

TEST(SiUnits, AreThoseOfThePaperByHand) {
  const Model model = fitted_paper_model();
  // Expected values, computed in Python: 37/0.0768, 1.3157 * 37/0.0768, 0.3028 * 37/0.0768, 3 *
  // 37/0.0768.
  EXPECT_NEAR(*quantity(model, "/max_wheel_force").estimate.value, 481.77083, 1e-5);
  EXPECT_NEAR(*quantity(model, "/surge/alpha").estimate.value, 633.86589, 1e-5);
  EXPECT_NEAR(*quantity(model, "/yaw/alpha").estimate.value, 145.88021, 1e-5);
  EXPECT_NEAR(*quantity(model, "/sway/alpha").estimate.value, 1445.3125, 1e-5);
  EXPECT_EQ(quantity(model, "/mass").estimate.value, 37.0);
  EXPECT_EQ(quantity(model, "/surge/alpha").unit, "N (s/m)^b1");
  EXPECT_EQ(quantity(model, "/yaw/alpha").unit, "N m (s/rad)^b3");
  EXPECT_EQ(quantity(model, "/yaw_inertia").unit, "kg m^2");
  EXPECT_EQ(si_quantities(model).size(), 6U);  // no exponent, no time, no term of other families
}

TEST(SiUnits, PropagateTheCovariance) {
  const SiQuantity alpha = quantity(uncertain_model(), "/surge/alpha");
  // Variance of ln(a1/m') with the correlation -0.6: 0.05^2 + 2 * 0.6 * 0.05 * 0.1 + 0.1^2
  const double relative = std::sqrt(0.0025 + 0.006 + 0.01);
  const double value = *alpha.estimate.value;
  EXPECT_NEAR(*alpha.estimate.std_error, relative * value, 1e-12 * value);
  EXPECT_NEAR(alpha.estimate.ci95->lo, value * std::exp(-2.0 * relative), 1e-12 * value);
  EXPECT_NEAR(alpha.estimate.ci95->hi, value * std::exp(2.0 * relative), 1e-12 * value);
}

TEST(SiUnits, InvertTheIntervalOfTheMass) {
  const Model model = uncertain_model();
  const Estimate force = quantity(model, "/max_wheel_force").estimate;
  const Interval& mass = *model[ParameterId::kMassNorm].ci95;
  EXPECT_DOUBLE_EQ(force.ci95->lo, 37.0 / mass.hi);
  EXPECT_DOUBLE_EQ(force.ci95->hi, 37.0 / mass.lo);
  EXPECT_NEAR(*force.std_error, 0.1 * *force.value, 1e-12 * *force.value);
}

TEST(SiUnits, OmitAnUnboundedInterval) {
  Model model = uncertain_model();
  model[ParameterId::kMassNorm].ci95 = Interval{0.0, 0.2};
  EXPECT_FALSE(quantity(model, "/max_wheel_force").estimate.ci95);
}

TEST(SiUnits, GiveTheInertiaThatWasGivenAsExact) {
  const Model model = uncertain_model();
  const Estimate inertia = quantity(model, "/yaw_inertia").estimate;
  // Tolerance: rounding of three products.
  EXPECT_NEAR(*inertia.value, model.vehicle.inertia_kgm2(), 1e-14 * *inertia.value);
  EXPECT_FALSE(inertia.std_error);
  EXPECT_FALSE(inertia.ci95);
}

TEST(SiUnits, HaveNoErrorWhereTheModelHasNoCovarianceOfIt) {
  Model model = uncertain_model();
  model.covariance = {};
  EXPECT_FALSE(quantity(model, "/surge/alpha").estimate.std_error);
  // Given values are exact; the error is that of m' alone.
  model = uncertain_model();
  const Estimate sway = quantity(model, "/sway/alpha").estimate;
  EXPECT_NEAR(*sway.std_error, 0.1 * *sway.value, 1e-12 * *sway.value);
}

TEST(SiUnits, KeepATermThatMayBeZeroLinear) {
  Model model = uncertain_model();
  model.surge_family = Family::kCoulombLinear;
  model[ParameterId::kSurgeCoulomb] = {0.0, 0.1, Interval{-0.2, 0.2}, Source::kFitted, ""};
  model.covariance.parameters[0] = ParameterId::kSurgeCoulomb;
  model.covariance.matrix = {{0.01, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const SiQuantity q = quantity(model, "/surge/coulomb");
  EXPECT_EQ(q.unit, "N");
  EXPECT_EQ(q.estimate.value, 0.0);
  EXPECT_NEAR(*q.estimate.std_error, 0.1 * 481.77083, 1e-5);
  EXPECT_NEAR(q.estimate.ci95->lo, -q.estimate.ci95->hi, 1e-9);
}

TEST(SiUnits, AreAbsentWithoutAMass) {
  Model model = fitted_paper_model();
  EXPECT_THAT(model_text(model), HasSubstr("\"si\""));
  model[ParameterId::kMassNorm] = {};
  EXPECT_TRUE(si_quantities(model).empty());
  EXPECT_THAT(model_text(model), Not(HasSubstr("\"si\"")));
}

}  // namespace
}  // namespace awmr::testing
