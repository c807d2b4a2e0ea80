/// Models of straight motion only, compared with their trials, the paper's claims and logs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "awmr/model/paper_gains.h"
#include "awmr/validate/validate.h"
#include "validate/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Model straight_model() {
  Model model = fitted_paper_model();
  add_paper_trials(model);
  std::erase_if(model.record.trials,
                [](const TrialPoint& trial) { return trial.kind == TrialKind::kTurning; });
  for (const ParameterId id :
       {ParameterId::kYawAlpha, ParameterId::kYawBeta, ParameterId::kSwayAlpha}) {
    model[id] = {};
  }
  return model;
}

std::vector<std::string> ids_of(const Validation& validation) {
  std::vector<std::string> ids;
  for (const Claim& claim : validation.claims) ids.push_back(claim.id);
  return ids;
}

TEST(PartialModel, PredictsItsTrialsAsTheWholeModelDoes) {
  Model whole = fitted_paper_model();
  add_paper_trials(whole);
  const auto expected = validate(whole, std::nullopt, {});
  const auto v = validate(straight_model(), std::nullopt, {});
  ASSERT_TRUE(v && expected) << to_text(v.error());
  EXPECT_EQ(v->surge_rms_relative_error, expected->surge_rms_relative_error);
  EXPECT_EQ(v->coastdown_rms_relative_error, expected->coastdown_rms_relative_error);
  EXPECT_FALSE(v->turning_rms_relative_error);
  EXPECT_TRUE(v->passed);
  EXPECT_EQ(ids_of(*v), (std::vector<std::string>{"C1", "C14"}));
  EXPECT_EQ(v->claims[0].figure, expected->claims[0].figure);
  EXPECT_THAT(v->verdict, HasSubstr("left out (C2)"));
}

TEST(PartialModel, OfSurgeRunsIsValidatedOnThem) {
  Model model = straight_model();
  model[ParameterId::kMassNorm] = model[ParameterId::kInertiaNorm] = {};
  model.record.trials.resize(2);
  const auto v = validate(model, std::nullopt, {});
  ASSERT_TRUE(v) << to_text(v.error());
  EXPECT_TRUE(v->passed);
  EXPECT_EQ(ids_of(*v), std::vector<std::string>{"C14"});
}

TEST(PartialModel, HasNoClosedLoopClaims) {
  const auto v = validate(straight_model(), kPaperGains, {});
  ASSERT_FALSE(v);
  EXPECT_EQ(exit_code(v.error()), 2);
  EXPECT_THAT(to_text(v.error()), HasSubstr("a turning trial"));
}

/// Log of two seconds of constant thrust. Its speed is that of the model, du/dt = (tau - g1(u))/m',
/// computed by Euler steps of 1 ms.
DrivingLog straight_log(double tau_speed) {
  const Plant<double> plant = fitted_paper_model().plant().value();
  DrivingLog log;
  log.file = "drive.csv";
  log.steering_command_rad.emplace();
  Measured speed;
  double u = 0.0;
  for (int i = 0; i <= 200; ++i) {
    log.line.push_back(i + 2);
    log.t_s.push_back(0.01 * i);
    log.force_left.push_back(tau_speed / 4.0);
    log.force_right.push_back(tau_speed / 4.0);
    log.steering_command_rad->push_back(0.0);
    speed.value.push_back(u);
    speed.fresh.push_back(true);
    for (int n = 0; n < 10; ++n) u += 0.001 * (tau_speed - plant.surge(u)) / plant.mass_norm;
  }
  speed.fresh_count = 201;
  log[LogChannel::kSpeed] = speed;
  log[LogChannel::kYawRate] = speed;  // straight motion does not predict it, whatever its values
  return log;
}

TEST(PartialModel, PredictsTheSpeedOfAStraightLog) {
  const auto v = validate_log(straight_log(1.0), straight_model(), 10.0, 0.3);
  ASSERT_TRUE(v) << to_text(v.error());
  ASSERT_EQ(v->channels.size(), 1U);
  EXPECT_EQ(v->channels[0].channel, "speed_mps");
  // Tolerance: the error of Euler's method is h/2 over the time constant m'/g1' of 0.07 s, a few
  // per cent of a short transient.
  EXPECT_LT(v->channels[0].long_horizon.nrmse, 0.05);
  EXPECT_TRUE(v->passed);
}

TEST(PartialModel, RefusesALogThatTurnsOrHasNoSpeed) {
  DrivingLog steers = straight_log(1.0);
  (*steers.steering_command_rad)[50] = 0.1;
  DrivingLog sides = straight_log(1.0);
  sides.force_left[50] = 0.1;
  for (const DrivingLog& log : {steers, sides}) {
    const auto v = validate_log(log, straight_model(), 10.0, 0.3);
    ASSERT_FALSE(v);
    EXPECT_THAT(to_text(v.error()), HasSubstr("drive.csv:52: the vehicle turns from this row"));
    EXPECT_THAT(to_text(v.error()), HasSubstr("a turning trial"));
  }
  DrivingLog dumb = straight_log(1.0);
  dumb[LogChannel::kSpeed].reset();
  const auto v = validate_log(dumb, straight_model(), 10.0, 0.3);
  ASSERT_FALSE(v);
  EXPECT_THAT(to_text(v.error()), HasSubstr("speed_mps"));
  EXPECT_THAT(to_text(v.error()), Not(HasSubstr("turning trial")));
}

}  // namespace
}  // namespace awmr::testing
