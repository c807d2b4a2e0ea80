#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trial_text.h"

namespace awmr::testing::surge_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

TEST(SurgeTrial, TakesFourWheelForcesAsTauSpeed) {
  const auto read = accepted(read_surge, "wheel_force,speed_mps\n0.35,1.03\n");
  ASSERT_THAT(read.set.rows, SizeIs(1));
  EXPECT_DOUBLE_EQ(read.set.rows[0].tau_speed, 1.4);
  EXPECT_FALSE(read.set.rows[0].elapsed_s);
  EXPECT_THAT(read.findings, IsEmpty());
}

TEST(SurgeTrial, TakesTwoWheelForcesOfFrontWheelDriveAsTauSpeed) {
  TrialOptions options;
  options.driven_wheels = 2;
  const auto read = accepted(read_surge, "wheel_force,speed_mps\n0.35,1.03\n", options);
  ASSERT_THAT(read.set.rows, SizeIs(1));
  EXPECT_DOUBLE_EQ(read.set.rows[0].tau_speed, 0.7);
}

TEST(SurgeTrial, TakesDistanceOverTimeWhereNoSpeedIsPrinted) {
  const auto read = accepted(read_surge, "tau_speed;distance_m;elapsed_s\r\n1.4;10;8\r\n");
  ASSERT_THAT(read.set.rows, SizeIs(1));
  EXPECT_EQ(read.set.rows[0].speed_mps, 1.25);
  EXPECT_EQ(read.set.rows[0].distance_m, 10.0);
  EXPECT_EQ(read.set.rows[0].elapsed_s, 8.0);
  EXPECT_THAT(read.findings, IsEmpty());
}

TEST(SurgeTrial, IgnoresADistanceWithoutATime) {
  const auto read = accepted(read_surge, "tau_speed,speed_mps,distance_m,note\n1,0.72,10,x\n");
  ASSERT_THAT(read.set.rows, SizeIs(1));
  EXPECT_FALSE(read.set.rows[0].distance_m);
}

TEST(SurgeTrial, ReadsOtherNamesAndUnits) {
  TrialOptions options;
  options.columns = {{"speed_mps", "v kmh", 1.0 / 3.6, 0.0}};
  const auto read = accepted(read_surge, "tau_speed,v kmh\n1,3.6\n", options);
  ASSERT_THAT(read.set.rows, SizeIs(1));
  EXPECT_DOUBLE_EQ(read.set.rows[0].speed_mps, 1.0);
}

TEST(SurgeTrial, DoesNotCallRoundingAContradiction) {
  // The timed speed is 10/18 = 0.5556, the printed one 0.55 or 0.56; 10/7.9 = 1.2658, printed 1.26.
  // The differences are below half a unit of the last place plus the timing error, 0.5556 (0.2/18 +
  // 0.005) = 0.009 and 1.2658 (0.2/7.9 + 0.005) = 0.038.
  EXPECT_THAT(accepted(read_surge,
                       "tau_speed,distance_m,elapsed_s,speed_mps\n0.8,10,18,0.55\n"
                       "0.8,10,18,0.56\n1.6,10,7.9,1.26\n")
                  .findings,
              IsEmpty());
}

TEST(SurgeTrial, FindsAContradictionOnEitherSide) {
  // At 1.25 m/s, a printed speed may differ from distance/time by 0.005 + 1.25 (0.2/8 + 0.005) =
  // 0.0425 m/s.
  const auto read = accepted(read_surge,
                             "tau_speed,distance_m,elapsed_s,speed_mps\n1.4,10,8,1.20\n"
                             "1.4,10,8,1.21\n1.4,10,8,1.29\n1.4,10,8,1.30\n");
  EXPECT_THAT(codes_of(read.findings), ElementsAre("speed-mismatch@2", "speed-mismatch@5"));
  EXPECT_THAT(read.set.rows, SizeIs(4));
}

TEST(SurgeTrial, FindsAContradictionAmongWholeNumbers) {
  EXPECT_THAT(
      codes_of(
          accepted(read_surge, "tau_speed,distance_m,elapsed_s,speed_mps\n1,20,16,1\n").findings),
      ElementsAre("speed-mismatch@2"));
}

TEST(SurgeTrial, FindsAPrintedRestThatMoved) {
  const auto read =
      accepted(read_surge, "tau_speed,distance_m,elapsed_s,speed_mps\n1,10,20,0\n1,10,20,0.5\n");
  EXPECT_THAT(codes_of(read.findings), ElementsAre("speed-mismatch@2", "rows-set-aside@2"));
}

TEST(SurgeTrial, FindsTwoThrustsThatDisagree) {
  const auto read =
      accepted(read_surge, "tau_speed,wheel_force,speed_mps\n1.4,0.35,1\n1.4,1.4,1\n");
  EXPECT_THAT(codes_of(read.findings), ElementsAre("tau-speed-mismatch@3"));
  EXPECT_EQ(read.set.rows[1].tau_speed, 1.4);
}

TEST(SurgeTrial, SetsRowsWithoutInformationAsideAndCountsThem) {
  const auto read = accepted(read_surge,
                             "# first line\ntau_speed,distance_m,elapsed_s,speed_mps\n0,0,0,0\n"
                             "0,10,0,0\n0.1,0,5,0\n1,10,13.9,0.72\n0,10,10,1\n");
  EXPECT_EQ(read.set.set_aside, 4);
  ASSERT_THAT(read.set.rows, SizeIs(1));
  EXPECT_EQ(read.set.rows[0].line, 6);
  ASSERT_THAT(codes_of(read.findings), ElementsAre("rows-set-aside@3"));
  EXPECT_THAT(read.findings[0].message, HasSubstr("4 of 5 rows are not used (lines 3, 4, 5, 7)"));
}

TEST(SurgeTrial, RefusesNegativeAndImpossibleCellsAllAtOnce) {
  EXPECT_THAT(faults_of(read_surge,
                        "tau_speed,distance_m,elapsed_s,speed_mps\n-1,10,8,1.25\n1,-10,8,1.25\n"
                        "1,10,-8,1.25\n1,10,8,-1.25\n1,10,0,1.25\n"),
              ElementsAre(StartsWith("2:1: "), StartsWith("3:3: "), StartsWith("4:6: "),
                          StartsWith("5:8: "), StartsWith("6:6: ")));
  EXPECT_THAT(faults_of(read_surge, "tau_speed,distance_m,elapsed_s\n1,10,0\n"),
              ElementsAre(StartsWith("2:6: ")));
}

}  // namespace
}  // namespace awmr::testing::surge_test
