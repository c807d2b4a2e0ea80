/// Resistance families other than the power law in the emitted firmware.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/control/feed_forward.h"
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
  // g1 at 1 m/s is alpha + q, within the table's relative error of 5e-4.
  const float at_one = parameters->surge.view()(1.0F);
  EXPECT_NEAR(static_cast<double>(at_one), 0.21 + 1.3268, 5e-4 * 1.54);
}

TEST(BackEmf, IsInTheHeaderAndOnTheChip) {
  Model model = paper_robot();
  model[ParameterId::kBackEmf] = {0.25, 0.01, {}, Source::kFitted, "trajectory"};
  const auto header = params_header(model, kPaperGains, paper_inputs());
  ASSERT_TRUE(header);
  EXPECT_THAT(*header, HasSubstr("#define AWMR_MOTOR_BACK_EMF 0.25f"));
  const auto firmware = autopilot_parameters(model, kPaperGains, paper_inputs(), {});
  ASSERT_TRUE(firmware) << to_text(firmware.error());
  ASSERT_TRUE(firmware->rest);
  EXPECT_EQ(firmware->rest->back_emf_s_per_m, 0.25F);
  EXPECT_EQ(firmware->rest->dead_zone, 0.0F);
  EXPECT_EQ(firmware->rest->surge_rest_speed, 0.0F);
  EXPECT_EQ(firmware->block.constants.allocation.force_max,
            static_cast<float>(model.vehicle.wheel_force.hi));
  EXPECT_THAT(autopilot_header(*firmware), HasSubstr("#define AWMR_BACK_EMF_S_PER_M 0.25f"));
}

/// Returns the rate >= 0 at which a rising function crosses zero, by bisection.
template <class F>
double zero_of(const F& rising) {
  double lo = 0.0;
  double hi = 1e3;
  for (int i = 0; i < 100; ++i) (rising(0.5 * (lo + hi)) < 0.0 ? lo : hi) = 0.5 * (lo + hi);
  return lo;
}

TEST(CommandSpeed, IsAtMostTheHighestSpeedOfTheTrialsElseThatOfFullForce) {
  Model model = paper_robot();
  const auto largest_mps = [&] {
    const auto parameters = autopilot_parameters(model, kPaperGains, paper_inputs(), {});
    EXPECT_THAT(autopilot_header(*parameters), HasSubstr("#define AWMR_COMMAND_SPEED_MAX_MPS "));
    return static_cast<double>(parameters->command_speed_max_mps);
  };
  // g1(u) = 4 F'max
  const double reachable_mps = std::pow(4.0 / 1.3268, 1.0 / 0.8933);
  EXPECT_NEAR(largest_mps(), reachable_mps, 1e-5);
  TrialPoint run;
  for (const double speed_mps : {0.8, 1.66, 1.2}) {
    run.measured = speed_mps;
    model.record.trials.push_back(run);
  }
  EXPECT_NEAR(largest_mps(), 1.66, 1e-6);
  // A speed that is a fault cannot be commanded.
  run.measured = 100.0;
  model.record.trials.push_back(run);
  const auto parameters = autopilot_parameters(model, kPaperGains, paper_inputs(), {});
  EXPECT_EQ(parameters->command_speed_max_mps, parameters->block.safety.speed_max_mps);
}

/// While a vehicle turns by 180 deg with the radius R, the distance times the heading error beyond
/// e0 adds up to R (pi - e0)^2/2. The limit is this value plus 10 m rad for the beginning of the
/// turn. Computed here independently of turn_of_vehicle() and turn_of_law().
TEST(OffCourse, IsTenPlusAHalfTurnOfTheWidestRadiusAtTheRoutesSpeeds) {
  const Model model = paper_robot();
  const Plant<double> plant = model.plant().value();
  const auto parameters = autopilot_parameters(model, kPaperGains, paper_inputs(), {});
  ASSERT_TRUE(parameters) << to_text(parameters.error());
  double most = 0.0;
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    const double speed_mps = share * static_cast<double>(parameters->route_speed_mps);
    const double force = plant.surge.at(speed_mps);
    const double moment_m =
        plant.front_axle_m * force * std::tan(0.5 * radians(model.vehicle.steering_max_deg));
    const double by_vehicle = zero_of([&](double rate) { return plant.yaw.at(rate) - moment_m; });
    const HeadingGains<double>& gains = kPaperGains.heading;
    const double by_law = zero_of([&](double rate) {
      return 1.4 * plant.yaw.at(rate) + 0.08 * plant.half_track_m * force - plant.yaw.at(rate) -
             plant.inertia_norm * (gains.mu - gains.lambda * rate);
    });
    const double beyond_rad = radians(180.0) - static_cast<double>(parameters->on_course_rad);
    most = std::max(
        most, 10.0 + 0.5 * beyond_rad * beyond_rad * speed_mps / std::min(by_vehicle, by_law));
  }
  EXPECT_NEAR(static_cast<double>(parameters->off_course_mrad), most, 1e-5 * most);
  EXPECT_LT(most, 90.0);
}

/// Unequal motors cause the steady heading error e with I'z lambda (mu/epsilon) e = 0.08 d g1(u).
/// The bound is twice this error, at least 15 and at most 45 deg.
TEST(OnCourse, IsTwiceTheErrorThatUnequalMotorsCause) {
  const Model model = paper_robot();
  const Plant<double> plant = model.plant().value();
  const auto error_rad = [&](double mu) {
    Gains<double> gains = kPaperGains;
    gains.heading.mu = mu;
    const auto parameters = autopilot_parameters(model, gains, paper_inputs(), {});
    EXPECT_TRUE(parameters) << to_text(parameters.error());
    const double moment_m = 0.08 * plant.half_track_m *
                            plant.surge.at(static_cast<double>(parameters->route_speed_mps));
    const double twice_rad =
        2.0 * moment_m * gains.heading.epsilon / (plant.inertia_norm * gains.heading.lambda * mu);
    EXPECT_NEAR(2.0 * parameters->steady_error_rad, twice_rad, 1e-12);
    return std::pair(static_cast<double>(parameters->on_course_rad), twice_rad);
  };
  const auto [soft_rad, soft_twice_rad] = error_rad(60.0);
  EXPECT_NEAR(soft_rad, soft_twice_rad, 1e-6);
  EXPECT_GT(soft_rad, radians(15.0));
  EXPECT_NEAR(error_rad(400.0).first, radians(15.0), 1e-6);
  EXPECT_NEAR(error_rad(25.0).first, radians(45.0), 1e-6);
}

TEST(FrontWheelDrive, IsRefusedByTheFirmwareAndHasAHeader) {
  Model model = paper_robot();
  model.vehicle.drive = Drive::kFrontWheel;
  EXPECT_TRUE(params_header(model, kPaperGains, paper_inputs()));
  const auto firmware = autopilot_parameters(model, kPaperGains, paper_inputs(), {});
  ASSERT_FALSE(firmware);
  EXPECT_THAT(to_text(firmware.error()), HasSubstr("/vehicle/drive"));
}

TEST(Families, AreRefusedWhereTheFirmwareDoesNotKnowThem) {
  EmitOptions by_powf;
  by_powf.resistance = ResistanceForm::kPowf;
  const auto powf = autopilot_parameters(quadratic_robot(), kPaperGains, paper_inputs(), by_powf);
  ASSERT_FALSE(powf);
  EXPECT_THAT(to_text(powf.error()), HasSubstr("needs the table"));
  const auto friction = autopilot_parameters(coulomb_robot(), kPaperGains, paper_inputs(), by_powf);
  ASSERT_FALSE(friction);
  EXPECT_THAT(to_text(friction.error()), HasSubstr("needs the table"));
}

TEST(Families, WithFrictionAtRestHaveATableFromTheRestSpeedOnAndTheValueThere) {
  const auto p = autopilot_parameters(coulomb_robot(), kPaperGains, paper_inputs(), {});
  ASSERT_TRUE(p) << to_text(p.error());
  const Plant<double> plant = coulomb_robot().plant().value();
  ASSERT_TRUE(p->rest);
  EXPECT_EQ(p->rest->surge_rest_speed, 0.02F);
  EXPECT_EQ(p->rest->surge_at_rest, static_cast<float>(plant.surge.at(0.02)));
  EXPECT_THAT(p->rest->yaw_rest_speed, ::testing::Each(0.0F));
  EXPECT_EQ(p->rest->dead_zone, 0.0F);
  // The chip's feed-forward equals that of the simulated controller within 5e-4. At rest, friction
  // has the sign of the error.
  const RestingTable chip{p->surge.view(), p->rest->surge_rest_speed, p->rest->surge_at_rest};
  const Resistance<double> law = feed_forward(plant.surge);
  for (const float speed :
       {-3.0F, -0.021F, -0.019F, -0.001F, 0.0F, 0.004F, 0.0199F, 0.0201F, 2.0F}) {
    for (const float error : {-1.0F, -0.003F, 0.0F, 0.01F, 0.5F}) {
      const double exact = fed_forward(law, static_cast<double>(speed), static_cast<double>(error));
      EXPECT_NEAR(static_cast<double>(fed_forward(chip, speed, error)), exact,
                  5e-4 * std::max(std::abs(exact), 0.2) + 1e-6)
          << speed << " " << error;
    }
    EXPECT_EQ(chip(-speed), -chip(speed));
  }
  EXPECT_TRUE(std::isnan(chip(std::nanf(""))));
  EXPECT_FALSE(autopilot_parameters(paper_robot(), kPaperGains, paper_inputs(), {})->rest);
}

TEST(Families, WithFrictionInYawHaveTheFrictionWidthOfTheGains) {
  Model model = coulomb_robot();
  model.yaw_family = Family::kCoulombPower;
  model[ParameterId::kYawCoulomb] = {0.03, 0.001, {}, Source::kFitted, "nonlinear"};
  Gains<double> gains = kPaperGains;
  gains.heading.friction_width_radps = 0.15;
  const auto p = autopilot_parameters(model, gains, paper_inputs(), {});
  ASSERT_TRUE(p) << to_text(p.error());
  EXPECT_EQ(p->rest->surge_rest_speed, 0.02F);
  EXPECT_THAT(p->rest->yaw_rest_speed, ::testing::ElementsAre(0.02F, 0.15F, 0.075F));
  for (int mode = 0; mode < kYawModeCount; ++mode) {
    const double width = static_cast<double>(p->rest->yaw_rest_speed[mode]);
    const Resistance<double> law = feed_forward(model.plant().value().yaw, width);
    EXPECT_FLOAT_EQ(p->rest->yaw_at_rest[mode], static_cast<float>(law.at(width)));
    // The chip's feed-forward equals that of the simulated controller.
    const RestingTable chip{p->yaw.view(), p->rest->yaw_rest_speed[mode],
                            p->rest->yaw_at_rest[mode]};
    for (const float rate : {-1.0F, -0.149F, 0.0F, 0.1F, 0.151F}) {
      for (const float error : {-0.2F, -0.03F, 0.0F, 0.1F}) {
        const double exact =
            fed_forward(law, static_cast<double>(rate), static_cast<double>(error));
        EXPECT_NEAR(static_cast<double>(fed_forward(chip, rate, error)), exact,
                    5e-4 * std::max(std::abs(exact), 0.2) + 1e-6)
            << mode << " " << rate << " " << error;
      }
    }
  }
  const auto has_width = [&](const Gains<double>& of) {
    return params_header(model, of, paper_inputs()).value().find("FRICTION_WIDTH") !=
           std::string::npos;
  };
  EXPECT_TRUE(has_width(gains));
  EXPECT_FALSE(has_width(kPaperGains));
  gains.heading.combined_friction_width_radps = 0.0625;
  EXPECT_EQ(autopilot_parameters(model, gains, paper_inputs(), {})->rest->yaw_rest_speed[2],
            0.0625F);
  EXPECT_THAT(params_header(model, gains, paper_inputs()).value(),
              HasSubstr("#define AWMR_HEADING_COMBINED_FRICTION_WIDTH_RADPS 0.0625f"));

  // With gains by mode, the header has the width of each mode.
  Gains<double> differential = kPaperGains;
  differential.heading.friction_width_radps = 0.3125;
  differential.observer = {1.0, 0.1, 0.5};
  ModeGains by_mode = gains;
  by_mode.set(YawMode::kDifferential, differential);
  const std::string header = params_header(model, by_mode, paper_inputs()).value();
  EXPECT_THAT(header, HasSubstr("#define AWMR_HEADING_FRICTION_WIDTH_RADPS_DIFFERENTIAL 0.3125f"));
  EXPECT_THAT(header, HasSubstr("#define AWMR_HEADING_FRICTION_WIDTH_RADPS_COMBINED 0.0625f"));
}

TEST(Families, WithADeadZoneAllocateWhatIsLeftBeyondIt) {
  Model zone = paper_robot();
  zone.surge_family = Family::kDeadZone;
  zone[ParameterId::kWheelDeadZone] = {0.05, 0.01, {}, Source::kFitted, "nonlinear"};
  const auto p = autopilot_parameters(zone, kPaperGains, paper_inputs(), {});
  ASSERT_TRUE(p) << to_text(p.error());
  EXPECT_EQ(p->rest->dead_zone, 0.05F);
  EXPECT_EQ(p->block.constants.allocation.force_max,
            static_cast<float>(zone.vehicle.wheel_force.hi - 0.05));
  EXPECT_THAT(autopilot_header(*p), HasSubstr("#define AWMR_DEAD_ZONE 0.0500000007f"));
  EXPECT_NE(p->crc, autopilot_parameters(paper_robot(), kPaperGains, paper_inputs(), {})->crc);
}

}  // namespace
}  // namespace awmr::testing
