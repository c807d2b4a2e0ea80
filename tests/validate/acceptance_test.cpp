/// A drive under the controller compared with the model's prediction: the modelled vehicle is
/// accepted in 95 % of the drives, a changed vehicle is rejected, and the change is named.
#include "awmr/validate/acceptance.h"

#include <gmock/gmock.h>

#include "awmr/core/random.h"
#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/plant_sampler.h"
#include "awmr/simulate/simulate.h"
#include "awmr/trials/log_start.h"
#include "awmr/validate/drive_series.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;

Scenario drive_scenario() {
  Scenario scenario = heading_steps({30.0, -30.0}, {.hold_s = 4.0});
  return under(conditions_of(paper_vehicle()), scenario);
}

/// Recording at 50 Hz of the vehicle under the controller: two seconds of waiting, then the run,
/// with the noise that the controller saw.
DrivingLog recorded(const Plant<double>& vehicle, const Scenario& world, std::uint64_t seed) {
  const Model model = uncertain_model();
  const Run run = simulate(vehicle, *controller_for(model, kPaperGains), world, YawMode::kCombined,
                           {.sample_time_s = 0.01, .substeps = {}, .seed = seed});
  DrivingLog log;
  log.file = "drive.csv";
  log.steering_command_rad.emplace();
  for (const LogChannel c : {LogChannel::kHeading, LogChannel::kSpeed, LogChannel::kYawRate}) {
    log[c].emplace();
  }
  constexpr int kWaiting = 100;
  const auto add = [&](double t_s, const RunRow& row, bool driven) {
    log.line.push_back(static_cast<int>(log.t_s.size()) + 2);
    log.t_s.push_back(t_s);
    log.force_left.push_back(driven ? row.force.left : 0.0);
    log.force_right.push_back(driven ? row.force.right : 0.0);
    log.steering_command_rad->push_back(driven ? row.steering_command_rad : 0.0);
    for (auto [channel, value] : {std::pair{LogChannel::kHeading, row.measured.psi_rad},
                                  std::pair{LogChannel::kSpeed, row.measured.u_mps},
                                  std::pair{LogChannel::kYawRate, row.measured.r_radps}}) {
      log[channel]->value.push_back(value);
      log[channel]->fresh.push_back(true);
      ++log[channel]->fresh_count;
    }
  };
  // At rest each reading has its own noise: that of the run's row, with another seed.
  Random random(seed, 99);
  for (int k = 0; k < kWaiting; ++k) {
    RunRow row = run.rows.front();
    row.measured.psi_rad = world.sensors->heading.noise * random.normal();
    row.measured.u_mps = world.sensors->speed.noise * random.normal();
    row.measured.r_radps =
        world.sensors->yaw_rate.bias + world.sensors->yaw_rate.noise * random.normal();
    add(0.02 * k, row, false);
  }
  for (std::size_t k = 0; k < run.rows.size(); k += 2) {
    add(0.02 * kWaiting + run.rows[k].t_s, run.rows[k], true);
  }
  return log;
}

Acceptance evaluate(const DrivingLog& log, AcceptanceOptions options = {.draws = 99}) {
  auto acceptance = accept_drive(log, uncertain_model(), kPaperGains,
                                 heading_steps({30.0, -30.0}, {.hold_s = 4.0}), options);
  EXPECT_TRUE(acceptance) << to_text(acceptance.error());
  return acceptance.value_or(Acceptance{});
}

const FaultHypothesis* hypothesis(const Acceptance& acceptance, std::string_view what) {
  for (const FaultHypothesis& one : acceptance.hypotheses) {
    if (one.what == what) return &one;
  }
  return nullptr;
}

TEST(Acceptance, AcceptsTheVehicleOfThePredictionAtTheStatedRate) {
  // 40 vehicles are drawn from the model's uncertainty. On average, 2 of them are rejected by
  // chance. More than 6 are rejected in 0.3 % of such series (binomial).
  const auto sampler = PlantSampler::make(uncertain_model());
  ASSERT_TRUE(sampler);
  int rejected = 0;
  for (int i = 1; i <= 40; ++i) {
    const auto plant = sampler->draw(77, i);
    ASSERT_TRUE(plant);
    const auto seed = static_cast<std::uint64_t>(1000 + i);
    // With 39 draws, as with 99, the level is exactly 5 %: drives with a p-value up to 2/40 are rejected.
    const Acceptance acceptance = evaluate(recorded(*plant, drive_scenario(), seed), {.draws = 39});
    rejected += acceptance.inside ? 0 : 1;
  }
  EXPECT_LE(rejected, 6);
}

TEST(Acceptance, BeginsWhereTheLogFirstCommandsAnything) {
  const Acceptance acceptance = evaluate(recorded(paper_plant(), drive_scenario(), 3));
  EXPECT_DOUBLE_EQ(acceptance.from_s, 2.0);
  EXPECT_NEAR(acceptance.duration_s, 8.0, 1e-9);
  EXPECT_EQ(acceptance.channels.size(), 6u);
  for (const ChannelAcceptance& one : acceptance.channels) {
    const bool read = one.channel == "heading_rad" || one.channel == "yaw_rate_radps" ||
                      one.channel == "speed_mps";
    EXPECT_EQ(one.noise_from_log, read) << one.channel;
    // The recorded readings have the default noise: 1 deg, 0.5 deg/s, 0.02 m/s.
    if (one.channel == "heading_rad") {
      EXPECT_NEAR(one.noise, radians(1.0), radians(0.2));
    } else if (one.channel == "speed_mps") {
      EXPECT_NEAR(one.noise, 0.02, 0.004);
    }
  }
}

TEST(Acceptance, BeginsAfterARowOfRestThatTheReaderAdded) {
  DrivingLog log;
  log.line = {2, 3};
  log.t_s = {0.0, 0.1};
  log.force_left = log.force_right = {0.2, 0.2};
  log.steering_command_rad = {0.1, 0.1};
  log[LogChannel::kSpeed] = Measured{.value = {0.0, 0.1}, .fresh = {true, true}, .fresh_count = 2};
  add_row_of_rest(log);  // the added row repeats the steering command of the next row
  ASSERT_EQ(log.rows(), 3U);
  const auto first = first_row_of(log, {});
  ASSERT_TRUE(first);
  EXPECT_EQ(*first, 1U);
}

TEST(Acceptance, NamesAHeavierVehicle) {
  Plant<double> heavier = paper_plant();
  heavier.mass_norm *= 3.0;
  const Acceptance acceptance = evaluate(recorded(heavier, drive_scenario(), 3));
  EXPECT_FALSE(acceptance.inside);
  const FaultHypothesis* mass = hypothesis(acceptance, "mass_norm");
  ASSERT_NE(mass, nullptr) << acceptance_table(acceptance);
  EXPECT_NEAR(mass->value, 3.0, 0.5);
}

TEST(Acceptance, NamesMotorsOfOneSideThatAreWeak) {
  Scenario world = drive_scenario();
  world.faults.push_back({{Wheel::kFrontLeft, Wheel::kRearLeft}, {}, 0.7});
  const Acceptance acceptance = evaluate(recorded(paper_plant(), world, 3));
  EXPECT_FALSE(acceptance.inside);
  const FaultHypothesis* motors = hypothesis(acceptance, "force of the left motors");
  ASSERT_NE(motors, nullptr) << acceptance_table(acceptance);
  EXPECT_NEAR(motors->value, 0.7, 0.05);
  EXPECT_GT(motors->explained, 0.8);
}

TEST(Acceptance, NamesABiasOfTheGyro) {
  Scenario world = drive_scenario();
  world.sensors->yaw_rate.bias = radians(6.0);
  const Acceptance acceptance = evaluate(recorded(paper_plant(), world, 3));
  EXPECT_FALSE(acceptance.inside);
  const FaultHypothesis* bias = hypothesis(acceptance, "bias of the yaw rate");
  ASSERT_NE(bias, nullptr) << acceptance_table(acceptance);
  EXPECT_NEAR(bias->value, 6.0, 0.6);
}

TEST(Acceptance, ReportsSinceWhenADriveIsOutside) {
  Scenario world = drive_scenario();
  world.faults.push_back({{Wheel::kFrontLeft, Wheel::kRearLeft}, {.from_s = 4.5}, 0.5});
  const Acceptance acceptance = evaluate(recorded(paper_plant(), world, 3));
  ASSERT_FALSE(acceptance.inside);
  std::optional<double> first;
  for (const ChannelAcceptance& one : acceptance.channels) {
    if (one.outside_since_s && (!first || *one.outside_since_s < *first))
      first = one.outside_since_s;
  }
  ASSERT_TRUE(first);
  EXPECT_GE(*first, 4.0);
  EXPECT_LE(*first, 6.0);
}

TEST(Acceptance, ABandWithoutGivenNoiseTakesTheLogsOwn) {
  DrivingLog log = recorded(paper_plant(), drive_scenario(), 3);
  Random random(5, 0);
  log[LogChannel::kX].emplace();
  for (std::size_t row = 0; row < log.rows(); ++row) {
    log[LogChannel::kX]->value.push_back(0.05 * random.normal());
    log[LogChannel::kX]->fresh.push_back(true);
  }
  const Acceptance acceptance = evaluate(log);
  const auto x = std::find_if(acceptance.channels.begin(), acceptance.channels.end(),
                              [](const ChannelAcceptance& one) { return one.channel == "x_m"; });
  ASSERT_NE(x, acceptance.channels.end());
  EXPECT_TRUE(x->noise_from_log);
  // The standard deviation of 400 readings has a standard error of 1/sqrt(2 * 400) = 3.5 %; if
  // estimated by medians, about 5 %.
  EXPECT_NEAR(x->noise, 0.05, 0.01);
  EXPECT_FALSE(x->inside) << "the predicted vehicle drives 8 m, the measured position is constant";
}

TEST(Acceptance, RefusesALogThatDoesNotMatchTheScenario) {
  const auto why = [](const DrivingLog& log, const AcceptanceOptions& options) {
    const auto refused =
        accept_drive(log, uncertain_model(), kPaperGains, drive_scenario(), options);
    return refused ? std::string("accepted") : to_text(refused.error());
  };
  DrivingLog log = recorded(paper_plant(), drive_scenario(), 3);
  EXPECT_THAT(why(log, {.draws = 10}), HasSubstr("39 to 10000"));
  EXPECT_THAT(why(log, {.from_s = 100.0}), HasSubstr("ends before 100 s"));
  EXPECT_THAT(why(log, {.from_s = 9.0}), HasSubstr("at least 2 s"));
  std::fill(log.force_left.begin(), log.force_left.end(), 0.0);
  std::fill(log.force_right.begin(), log.force_right.end(), 0.0);
  std::fill(log.steering_command_rad->begin(), log.steering_command_rad->end(), 0.0);
  EXPECT_THAT(why(log, {}), HasSubstr("commands nothing"));
}

TEST(Acceptance, IsTheSameForAnyNumberOfThreads) {
  const DrivingLog log = recorded(paper_plant(), drive_scenario(), 3);
  const Acceptance one = evaluate(log, {.draws = 40, .threads = 1});
  const Acceptance three = evaluate(log, {.draws = 40, .threads = 3});
  EXPECT_EQ(one.p_value, three.p_value);
  EXPECT_EQ(acceptance_table(one), acceptance_table(three));
}

}  // namespace
}  // namespace awmr::testing
