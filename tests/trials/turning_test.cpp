#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "awmr/core/units.h"
#include "trial_text.h"

namespace awmr::testing::turning_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

TEST(TurningTrial, ComputesTheYawMomentWhereNoneIsPrinted) {
  const auto read =
      accepted(kReadTurning, "steering_deg,wheel_force,yaw_rate_radps\n10,0.35,0.1\n");
  ASSERT_THAT(read.set.rows, SizeIs(1));
  // tau_turn = 2 l_f F' sin d_r                                                     [paper (62)]
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
  // tau_turn = 2 0.35 0.35 sin 10 deg = 0.04254 m. Tolerance: 0.00005 for rounding plus 1 %,
  // 0.00048.
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

TEST(TurningTrial, RefusesNegativeAndImpossibleCellsAllAtOnce) {
  EXPECT_THAT(
      faults_of(
          kReadTurning,
          "steering_deg,wheel_force,turns,elapsed_s,yaw_rate_radps\n10,-0.35,1,71,0.088\n"
          "10,0.35,-1,71,0.088\n10,0.35,1,-71,0.088\n10,0.35,1,0,0.088\n90,0.35,1,71,0.088\n"),
      ElementsAre(StartsWith("2:4: "), StartsWith("3:9: "), StartsWith("4:11: "),
                  StartsWith("5:11: "), StartsWith("6:1: ")));
}

/// Reads a turning table for a vehicle without steering with half_track_m 0.36.
const auto kReadSides = [](const std::filesystem::path& path, const TrialOptions& options,
                           std::vector<Finding>& findings) {
  Vehicle vehicle = paper_vehicle();
  vehicle.drive = Drive::kDifferential;
  return read_turning(path, vehicle, options, findings);
};

TEST(TurningTrial, KeepsDifferentialTurnsApartFromSteeredOnes) {
  const auto read =
      accepted(kReadTurning,
               "steering_deg,wheel_force,yaw_rate_radps,force_left,force_right\n"
               "10,0.35,0.1,,\n0,,0.2,0.1,0.3\n0,0.2,-0.2,0.3,0.1\n5,,0.05,0.3,0.3\n");
  ASSERT_THAT(read.set.rows, SizeIs(2));
  EXPECT_EQ(read.set.rows[1].wheel_force, 0.3);
  ASSERT_THAT(read.set.by_sides, SizeIs(2));
  for (const TurningRow& row : read.set.by_sides) {
    // tau_turn = 2 d (F'R - F'L)                                                    [paper (41)]
    EXPECT_DOUBLE_EQ(row.tau_turn_m, 2.0 * 0.36 * 0.2);
    EXPECT_EQ(row.yaw_rate_radps, 0.2);
    EXPECT_EQ(row.sides->right, 0.3);
  }
  EXPECT_THAT(read.findings, IsEmpty());
}

TEST(TurningTrial, UsesDifferentialTurnsForYawResistanceIfThereAreNoOthers) {
  const auto read = accepted(kReadTurning,
                             "steering_deg,force_left,force_right,yaw_rate_radps\n"
                             "0,0.1,0.3,0.2\n0,0.1,0.4,0.3\n");
  EXPECT_THAT(read.set.rows, SizeIs(2));
  EXPECT_THAT(read.set.by_sides, IsEmpty());
  EXPECT_THAT(codes_of(read.findings), ElementsAre("turned-by-sides@2"));
}

TEST(TurningTrial, RefusesRunsThatTurnBothWaysOrContradictThemselves) {
  const std::string header = "steering_deg,wheel_force,yaw_rate_radps,force_left,force_right\n";
  const std::string steered = "10,0.35,0.1,,\n";
  EXPECT_THAT(faults_of(kReadTurning, header + steered + "5,,0.2,0.1,0.3\n"),
              ElementsAre(AllOf(StartsWith("3:1: "),
                                HasSubstr("either by steering or by a force difference"))));
  EXPECT_THAT(faults_of(kReadTurning, header + steered + "0,0.5,0.2,0.1,0.3\n"),
              ElementsAre(AllOf(StartsWith("3:3: "), HasSubstr("is 0.2"))));
  EXPECT_THAT(faults_of(kReadTurning, header + steered + "0,,0.2,0.1,0.3\n0,,0.2,0.1,\n"),
              ElementsAre(HasSubstr("both forces or neither")));
  EXPECT_THAT(faults_of(kReadTurning, header + steered + "0,,,0.1,0.3\n"),
              ElementsAre(HasSubstr("no yaw rate")));
  EXPECT_THAT(faults_of(kReadTurning, header + steered + "0,,0.2,0.3,0.1\n"),
              ElementsAre(HasSubstr("signs must agree")));
  // Cells required of a steered run are reported as missing, as in a table of only steered runs.
  EXPECT_THAT(faults_of(kReadTurning, header + steered + "10,,0.1,,\n0,,0.2,0.1,0.3\n"),
              ElementsAre(AllOf(StartsWith("3:4: "), HasSubstr("the cell is empty"))));
  EXPECT_THAT(faults_of(kReadTurning, "steering_deg,force_left,yaw_rate_radps\n0,0.1,0.2\n"),
              ElementsAre(HasSubstr("belong together")));
  EXPECT_THAT(faults_of(kReadTurning, "steering_deg,yaw_rate_radps\n0,0.2\n"),
              ElementsAre(HasSubstr("no force")));
}

TEST(TurningTrial, KeepsDifferentialRunsWithoutATurn) {
  const std::string header = "steering_deg,wheel_force,force_left,force_right,turns,elapsed_s\n";
  const auto read = accepted(kReadTurning, header +
                                               "10,0.35,,,2,142\n0,,0.1,0.3,0,20\n"
                                               "0,,0.2,0.1,1,30\n");
  EXPECT_THAT(read.set.rows, SizeIs(1));
  EXPECT_THAT(read.set.by_sides, SizeIs(1));
  ASSERT_THAT(read.set.standing, SizeIs(1));
  EXPECT_DOUBLE_EQ(read.set.standing[0].tau_turn_m, 2.0 * 0.36 * 0.2);
  EXPECT_EQ(read.set.standing[0].line, 3);
  EXPECT_EQ(read.set.set_aside, 0);
  // Differential turns in which the vehicle stood give no information without steered turns.
  const auto alone = accepted(kReadTurning,
                              "steering_deg,force_left,force_right,turns,elapsed_s\n"
                              "0,0.1,0.3,0,20\n0,0.2,0.1,1,30\n");
  EXPECT_THAT(alone.set.rows, SizeIs(1));
  EXPECT_THAT(alone.set.standing, IsEmpty());
  EXPECT_EQ(alone.set.set_aside, 1);
}

TEST(TurningTrial, TakesAPrintedMomentWhereARowHasOne) {
  const auto read = accepted(kReadTurning,
                             "steering_deg,wheel_force,yaw_rate_radps,tau_turn\n"
                             "5,0.35,0.038,\n10,0.35,0.088,0.0425\n15,0.35,0.15,\n");
  ASSERT_THAT(read.set.rows, SizeIs(3));
  EXPECT_EQ(read.set.rows[1].tau_turn_m, 0.0425);
  // tau_turn = 2 l_f F' sin d_r                                                     [paper (62)]
  EXPECT_DOUBLE_EQ(read.set.rows[0].tau_turn_m, 2.0 * 0.35 * 0.35 * std::sin(radians(5.0)));
  EXPECT_DOUBLE_EQ(read.set.rows[2].tau_turn_m, 2.0 * 0.35 * 0.35 * std::sin(radians(15.0)));
  EXPECT_THAT(read.findings, IsEmpty());
}

TEST(TurningTrial, TakesAColumnThatNoRowHasForNoColumn) {
  const auto sides = accepted(kReadTurning,
                              "steering_deg,wheel_force,yaw_rate_radps,force_left,force_right\n"
                              "0,,0.2,0.1,0.3\n0,,0.3,0.1,0.4\n");
  EXPECT_THAT(sides.set.rows, SizeIs(2));
  const auto steered = accepted(kReadTurning,
                                "steering_deg,wheel_force,yaw_rate_radps,turns,elapsed_s\n"
                                "10,0.35,,2,142\n15,0.35,,2,83\n");
  EXPECT_DOUBLE_EQ(steered.set.rows[0].yaw_rate_radps, 4.0 * pi<double>() / 142.0);
  EXPECT_THAT(steered.findings, IsEmpty());
}

TEST(TurningTrial, NeedsARateInEachRowAndLeavesNoneOut) {
  EXPECT_THAT(faults_of(kReadTurning,
                        "steering_deg,wheel_force,yaw_rate_radps\n10,0.35,0.1\n"
                        "15,0.35,\n20,0.35,0.2\n20,0.35,0.2\n20,0.35,0.2\n"),
              ElementsAre(AllOf(StartsWith("3:9: "), HasSubstr("no yaw rate"))));
  // An earlier version silently dropped a row with only an angle.
  EXPECT_THAT(faults_of(kReadTurning,
                        "steering_deg,wheel_force,yaw_rate_radps\n10,0.35,0.1\n"
                        "15,,\n20,0.35,0.2\n"),
              ElementsAre(StartsWith("3:5: "), StartsWith("3:4: ")));
  // A formula must not reuse values of the previous row.
  EXPECT_THAT(faults_of(kReadTurning, "steering_deg,wheel_force,a,b\n10,0.35,0.1,1\n15,0.35,,1\n",
                        {.columns = {*parse_column("yaw_rate_radps=a*b")}}),
              ElementsAre(HasSubstr("no yaw rate")));
}

TEST(TurningTrialOfSides, NamesAllRowsWithoutForcesInOneSentence) {
  EXPECT_THAT(faults_of(kReadSides,
                        "force_left,force_right,yaw_rate_radps\n,,0.1\n0.1,0.3,0.2\n"
                        ",,0.2\n0.1,,0.2\n"),
              ElementsAre(AllOf(StartsWith("2:1: "), HasSubstr("3 of 4 rows"),
                                HasSubstr("(lines 2, 4, 5)"), HasSubstr("vehicle.json"))));
  EXPECT_THAT(faults_of(kReadSides, "force_left,force_right,yaw_rate_radps\n,,0.1\n,,0.2\n"),
              ElementsAre(HasSubstr("2 of 2 rows")));
}

TEST(TurningTrialOfSides, ComputesTheYawMomentAndMirrorsATurnToTheRight) {
  const auto read = accepted(kReadSides,
                             "force_left,force_right,yaw_rate_radps\n"
                             "-0.1,0.2,0.5\n0.2,-0.1,-0.5\n0.1,0.1,0\n");
  ASSERT_THAT(read.set.rows, SizeIs(2));
  for (const TurningRow& row : read.set.rows) {
    // tau_turn = 2 d (F'R - F'L)                                                    [paper (41)]
    EXPECT_DOUBLE_EQ(row.tau_turn_m, 2.0 * 0.36 * 0.3);
    EXPECT_EQ(row.yaw_rate_radps, 0.5);
    EXPECT_EQ(row.sides->left, -0.1);
    EXPECT_EQ(row.sides->right, 0.2);
    EXPECT_EQ(row.steering_rad, 0.0);
  }
  EXPECT_EQ(read.set.set_aside, 1);
}

TEST(TurningTrialOfSides, ReportsAPrintedMomentThatTheTrackContradicts) {
  const auto read = accepted(kReadSides,
                             "force_left,force_right,turns,elapsed_s,tau_turn\n"
                             "-0.1,0.1,1,10,0.288\n");
  ASSERT_THAT(codes_of(read.findings), ElementsAre("tau-turn-mismatch@2"));
  EXPECT_THAT(read.findings[0].message, HasSubstr("it implies a half_track_m of 0.720"));
  EXPECT_EQ(read.set.rows[0].tau_turn_m, 0.288);
}

TEST(TurningTrialOfSides, RefusesSignsThatDisagreeAndOtherColumns) {
  EXPECT_THAT(faults_of(kReadSides, "force_left,force_right,yaw_rate_radps\n0.1,-0.1,0.5\n"),
              ElementsAre(AllOf(StartsWith("2:10"), HasSubstr("signs must agree"))));
  EXPECT_THAT(
      faults_of(kReadSides, "force_left,force_right,yaw_rate_radps,tau_turn\n-0.1,0.1,0.5,-0.1\n"),
      ElementsAre(AllOf(StartsWith("2:14"), HasSubstr("signs must agree"))));
  EXPECT_THAT(faults_of(kReadSides, "steering_deg,wheel_force,yaw_rate_radps\n10,0.35,0.1\n"),
              Not(IsEmpty()));
  EXPECT_THAT(faults_of(kReadSides, "force_left,force_right\n-0.1,0.1\n"),
              ElementsAre(HasSubstr("no yaw rate")));
}

}  // namespace
}  // namespace awmr::testing::turning_test
