/// Tyres of several vehicles, found in their logs.
#include <gtest/gtest.h>

#include "awmr/validate/tyre_fit.h"
#include "validate/tyre_vehicle.h"

namespace awmr::testing {
namespace {

struct Truth {
  double friction;
  double stiffness;
};

TEST(TyreTruths, AreFoundWithinTheirIntervals) {
  constexpr Truth kTruths[] = {{0.8, 10.0}, {0.4, 6.0}, {0.6, 14.0},
                               {0.3, 20.0}, {0.7, 5.0}, {0.5, 8.0}};
  int held = 0;
  int shown = 0;
  int four_wheel = 0;
  for (unsigned seed = 1; seed <= 18; ++seed) {
    const Truth truth = kTruths[seed % std::size(kTruths)];
    std::vector<Finding> findings;
    const auto fit = fit_tyres({driven({.friction = truth.friction,
                                        .stiffness = truth.stiffness,
                                        .duration_s = 90.0,
                                        .seed = seed})},
                               identified(), findings);
    ASSERT_TRUE(fit && *fit) << seed;
    const auto count = [&](const std::optional<Estimate>& estimate, double value) {
      if (!estimate) return;
      ++shown;
      held += estimate->ci95->contains(value) ? 1 : 0;
      EXPECT_LT(log_errors_off(*estimate, value), 5.0) << seed << ": " << *estimate->value;
    };
    count((*fit)->friction, truth.friction);
    count((*fit)->cornering_per_rad, truth.stiffness);
    four_wheel += (*fit)->better == PlantKind::kFourWheel ? 1 : 0;
    EXPECT_NE((*fit)->better, PlantKind::kModel) << seed;
  }
  RecordProperty("held", held);
  RecordProperty("shown", shown);
  EXPECT_GE(shown, 34);
  // Each of 36 intervals contains the true value with a probability of 95 %. If they were
  // independent, fewer than 30 would do so in 1 of 550 cases.
  EXPECT_GE(held, 30) << "of " << shown;
  EXPECT_GE(four_wheel, 16);
}

TEST(TyreTruths, AFrictionThatIsNotIdentifiedIsFixed) {
  std::vector<Finding> findings;
  const auto fit = fit_tyres({driven({.friction = 3.0,
                                      .stiffness = 8.0,
                                      .force = 0.3,
                                      .apart = 0.1,
                                      .steering_deg = 4.0})},
                             identified(), findings)
                       .value();
  ASSERT_TRUE(fit && fit->cornering_per_rad);
  EXPECT_FALSE(fit->friction);
  EXPECT_EQ(fit->tyres.friction, kTyreFriction);
  EXPECT_LT(log_errors_off(*fit->cornering_per_rad, 8.0), 3.5) << *fit->cornering_per_rad->value;
  EXPECT_EQ(findings.front().code, "tyres-not-shown");
}

}  // namespace
}  // namespace awmr::testing
