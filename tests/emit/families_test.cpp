/// Families other than the power law on their way to the chip.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emit/paper_robot.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Model coulomb_robot() {
  Model model = paper_robot();
  model.surge_family = Family::kCoulombPower;
  model[ParameterId::kSurgeCoulomb] = {0.21, 0.01, {}, Source::kFitted, "nonlinear"};
  return model;
}

TEST(Families, PutTheirTermsIntoTheHeaderAndOnlyThen) {
  const auto plain = params_header(paper_robot(), kPaperGains, paper_inputs());
  const auto other = params_header(coulomb_robot(), kPaperGains, paper_inputs());
  ASSERT_TRUE(plain && other);
  EXPECT_THAT(*plain, Not(HasSubstr("COULOMB")));
  EXPECT_THAT(*other, HasSubstr("#define AWMR_SURGE_COULOMB 0.209999993f"));
}

Model quadratic_robot() {
  Model model = paper_robot();
  model.surge_family = Family::kCoulombLinearQuadratic;
  model[ParameterId::kSurgeQuadratic] = {0.21, 0.01, {}, Source::kFitted, "nonlinear"};
  return model;
}

TEST(Families, GoToTheChipAsTheirTable) {
  const auto parameters = autopilot_parameters(quadratic_robot(), kPaperGains, paper_inputs(), {});
  ASSERT_TRUE(parameters) << to_text(parameters.error());
  // g1 at 1 m/s: alpha + q, within the bound of 5e-4 of it.
  const float at_one = parameters->surge.view()(1.0F);
  EXPECT_NEAR(static_cast<double>(at_one), 0.21 + 1.3268, 5e-4 * 1.54);
}

TEST(Families, AreRefusedWhereTheFirmwareDoesNotKnowThem) {
  EmitOptions by_powf;
  by_powf.resistance = ResistanceForm::kPowf;
  const auto powf = autopilot_parameters(quadratic_robot(), kPaperGains, paper_inputs(), by_powf);
  ASSERT_FALSE(powf);
  EXPECT_THAT(to_text(powf.error()), HasSubstr("needs the table"));
  const auto friction = autopilot_parameters(coulomb_robot(), kPaperGains, paper_inputs(), {});
  ASSERT_FALSE(friction);
  EXPECT_THAT(to_text(friction.error()), HasSubstr("/surge/coulomb"));
  Model zone = paper_robot();
  zone.surge_family = Family::kDeadZone;
  zone[ParameterId::kWheelDeadZone] = {0.05, 0.01, {}, Source::kFitted, "nonlinear"};
  const auto refused = autopilot_parameters(zone, kPaperGains, paper_inputs(), {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_text(refused.error()), HasSubstr("/wheel/dead_zone"));
}

}  // namespace
}  // namespace awmr::testing
