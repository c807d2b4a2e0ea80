/// Validation of a model on logs.
#include <gtest/gtest.h>

#include <cmath>

#include "awmr/core/units.h"
#include "awmr/trials/replay.h"
#include "awmr/validate/validate.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

Plant<double> plant(double alpha) {
  Plant<double> plant = paper_plant();
  plant.surge = {.alpha = alpha, .beta = 0.9};
  plant.yaw = {.alpha = 0.3, .beta = 0.8};
  plant.mass_norm = 0.3;
  plant.inertia_norm = 0.05;
  plant.steering_max_rate_radps = 5.0;
  plant.steering_time_constant_s = 0.05;
  return plant;
}

/// Response of plant(1) to steps of thrust and steering, at 50 Hz, without noise.
DrivingLog exact_log() {
  DrivingLog log;
  log.file = "exact.csv";
  log.steering_command_rad.emplace();
  for (int i = 0; i < 1000; ++i) {
    log.line.push_back(i + 2);
    log.t_s.push_back(0.02 * i);
    const double force = i / 100 % 2 == 0 ? 0.3 : 0.15;
    log.force_left.push_back(force);
    log.force_right.push_back(force);
    log.steering_command_rad->push_back(i / 150 % 2 == 0 ? 0.2 : -0.2);
  }
  for (const LogChannel c : {LogChannel::kHeading, LogChannel::kSpeed, LogChannel::kYawRate}) {
    log[c] = Measured{std::vector<double>(1000), std::vector<bool>(1000, true), 1000, false};
  }
  const LogSignals signals(log);
  replay<double>(signals, 0, 1000, plant(1.0), nullptr, 1e-3, {},
                 [&](std::size_t row, const State<double>& s) {
                   log[LogChannel::kHeading]->value[row] = s.psi_rad;
                   log[LogChannel::kSpeed]->value[row] = s.u_mps;
                   log[LogChannel::kYawRate]->value[row] = s.r_radps;
                 });
  return log;
}

TEST(LogValidation, TheTrueModelPredictsExactly) {
  const LogValidation validation = validate_log(exact_log(), plant(1.0), 5.0, 0.1);
  ASSERT_EQ(validation.channels.size(), 3U);
  EXPECT_TRUE(validation.passed);
  for (const ChannelValidation& c : validation.channels) {
    // Errors have only two causes: states that are not measured are assumed at the start of each
    // window (servo at its command, no sway), and the log samples its commands at 50 Hz.
    EXPECT_LT(c.long_horizon.nrmse, 0.1) << c.channel;
    EXPECT_LT(c.one_step.nrmse, 0.03) << c.channel;
    EXPECT_NEAR(c.long_horizon.r2, 1.0 - c.long_horizon.nrmse * c.long_horizon.nrmse, 1e-12);
  }
}

TEST(LogValidation, HorizonIsAtMostTheLengthOfTheLog) {
  EXPECT_EQ(validate_log(exact_log(), plant(1.0), 5.0, 0.1).horizon_s, 5.0);
  EXPECT_NEAR(validate_log(exact_log(), plant(1.0), 100.0, 0.1).horizon_s, 999 * 0.02, 1e-9);
}

TEST(LogValidation, AWrongModelShowsOverAWindowWhatOneStepHides) {
  const LogValidation validation = validate_log(exact_log(), plant(1.5), 5.0, 0.05);
  EXPECT_FALSE(validation.passed);
  for (const ChannelValidation& c : validation.channels) {
    if (c.channel != "speed_mps") continue;
    EXPECT_GT(c.long_horizon.nrmse, 5.0 * c.one_step.nrmse);
    EXPECT_GT(c.long_horizon.nrmse, 0.5);
  }
}

TEST(LogValidation, DecidesWhereAModelHasNoTrialsOfItsOwn) {
  Validation good;
  add_logs(good, {validate_log(exact_log(), plant(1.0), 5.0, 0.1)}, 0.1);
  EXPECT_TRUE(good.passed);
  Validation bad;
  add_logs(bad, {validate_log(exact_log(), plant(1.5), 5.0, 0.05)}, 0.05);
  EXPECT_FALSE(bad.passed);
  EXPECT_NE(bad.verdict.find("0 of 1"), std::string::npos);
}

}  // namespace
}  // namespace awmr::testing
