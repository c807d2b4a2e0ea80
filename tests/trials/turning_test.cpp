#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "awmr/core/units.h"
#include "trial_text.h"

namespace awmr::testing {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

TEST(TurningTrial, ComputesTheYawMomentWhereNoneIsPrinted) {
  const auto read =
      accepted(kReadTurning, "steering_deg,wheel_force,yaw_rate_radps\n10,0.35,0.1\n");
  ASSERT_THAT(read.set.rows, SizeIs(1));
  // 2 l_f F' sin d_r                                                                [paper (62)]
  EXPECT_DOUBLE_EQ(read.set.rows[0].tau_turn_m, 2.0 * 0.35 * 0.35 * std::sin(radians(10.0)));
  EXPECT_THAT(read.findings, IsEmpty());
}

TEST(TurningTrial, TakesTurnsOverTimeWhereNoYawRateIsPrinted) {
  const auto read =
      accepted(kReadTurning, "steering_deg,wheel_force,turns,elapsed_s\n10,0.35,2,142\n");
  ASSERT_THAT(read.set.rows, SizeIs(1));
  EXPECT_DOUBLE_EQ(read.set.rows[0].yaw_rate_radps, 4.0 * pi<double>() / 142.0);
  EXPECT_EQ(read.set.rows[0].turns, 2.0);
  EXPECT_EQ(read.set.rows[0].elapsed_s, 142.0);
}

TEST(TurningTrial, UsesTheTimedYawRateWherePreferred) {
  const auto read =
      accepted(kReadTurning,
               "steering_deg,wheel_force,turns,elapsed_s,yaw_rate_radps\n5,0.35,1,83.34,0.038\n",
               {.columns = {}, .preference = Preference::kTimed});
  ASSERT_THAT(read.set.rows, SizeIs(1));
  EXPECT_DOUBLE_EQ(read.set.rows[0].yaw_rate_radps, 2.0 * pi<double>() / 83.34);
  ASSERT_THAT(codes_of(read.findings), ElementsAre("yaw-rate-mismatch@2"));
  EXPECT_THAT(read.findings[0].message, HasSubstr("the timed value 0.07539 is used"));
}

TEST(TurningTrial, MirrorsATurnToTheRight) {
  const auto read = accepted(kReadTurning,
                             "steering_deg,wheel_force,yaw_rate_radps,tau_turn\n"
                             "10,0.35,0.088,0.0425\n-10,0.35,-0.088,-0.0425\n");
  ASSERT_THAT(read.set.rows, SizeIs(2));
  EXPECT_EQ(read.set.rows[0].steering_rad, read.set.rows[1].steering_rad);
  EXPECT_EQ(read.set.rows[0].tau_turn_m, read.set.rows[1].tau_turn_m);
  EXPECT_EQ(read.set.rows[0].yaw_rate_radps, read.set.rows[1].yaw_rate_radps);
  EXPECT_THAT(read.findings, IsEmpty());
}

TEST(TurningTrial, RefusesSignsThatDisagree) {
  EXPECT_THAT(
      faults_of(kReadTurning,
                "steering_deg,wheel_force,yaw_rate_radps,tau_turn\n-10,0.35,0.088,0.0425\n"),
      ElementsAre(AllOf(StartsWith("2:10: "), HasSubstr("signs")), StartsWith("2:16: ")));
}

TEST(TurningTrial, FindsAYawMomentThatTheGeometryDoesNotGive) {
  // 2 0.35 0.35 sin 10 deg = 0.04254; tolerance 0.00005 + 1 % = 0.00048.
  const auto read =
      accepted(kReadTurning,
               "steering_deg,wheel_force,yaw_rate_radps,tau_turn\n10,0.35,0.088,0.0420\n"
               "10,0.35,0.088,0.0421\n10,0.35,0.088,0.0430\n10,0.35,0.088,0.0431\n");
  EXPECT_THAT(codes_of(read.findings), ElementsAre("tau-turn-mismatch@2", "tau-turn-mismatch@5"));
  EXPECT_EQ(read.set.rows[0].tau_turn_m, 0.042);
}

TEST(TurningTrial, FindsSteeringBeyondTheStopOnEitherSide) {
  const auto read = accepted(kReadTurning,
                             "steering_deg,wheel_force,yaw_rate_radps\n20,0.35,0.2\n20.1,0.35,0.2\n"
                             "-25,0.35,-0.2\n");
  EXPECT_THAT(codes_of(read.findings), ElementsAre("steering-stop@3", "steering-stop@4"));
  EXPECT_THAT(read.set.rows, SizeIs(3));
}

TEST(TurningTrial, SetsRowsWithoutInformationAside) {
  const auto read =
      accepted(kReadTurning,
               "steering_deg,wheel_force,yaw_rate_radps\n0,0.35,0\n10,0,0\n10,0.35,0\n"
               "0,0.35,0.01\n10,0.35,0.088\n");
  EXPECT_EQ(read.set.set_aside, 4);
  EXPECT_THAT(read.set.rows, SizeIs(1));
  EXPECT_THAT(codes_of(read.findings), ElementsAre("rows-set-aside@2"));
}

TEST(TurningTrial, NeedsItsColumns) {
  EXPECT_THAT(faults_of(kReadTurning, "wheel_force,yaw_rate_radps\n1,1\n"),
              ElementsAre(HasSubstr("steering_deg")));
  EXPECT_THAT(faults_of(kReadTurning, "steering_deg,yaw_rate_radps\n1,1\n"),
              ElementsAre(HasSubstr("wheel_force")));
  EXPECT_THAT(faults_of(kReadTurning, "steering_deg,wheel_force,elapsed_s\n1,1,1\n"),
              ElementsAre(HasSubstr("turns")));
}

TEST(TurningTrial, RefusesNegativeAndImpossibleCellsAllAtOnce) {
  EXPECT_THAT(
      faults_of(
          kReadTurning,
          "steering_deg,wheel_force,turns,elapsed_s,yaw_rate_radps\n10,-0.35,1,71,0.088\n"
          "10,0.35,-1,71,0.088\n10,0.35,1,-71,0.088\n10,0.35,1,0,0.088\n90,0.35,1,71,0.088\n"),
      ElementsAre(StartsWith("2:4: "), StartsWith("3:9: "), StartsWith("4:11: "),
                  StartsWith("5:11: "), StartsWith("6:1: ")));
}

}  // namespace
}  // namespace awmr::testing
