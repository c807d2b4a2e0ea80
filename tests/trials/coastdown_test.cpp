#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "trial_text.h"

namespace awmr {
namespace {

using testing::accepted;
using ::testing::AllOf;
using testing::codes_of;
using ::testing::ElementsAre;
using testing::faults_of;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

TEST(CoastdownTrial, ReadsARowPerRun) {
  const auto read =
      accepted(read_coastdown, "initial_speed_mps\tstop_time_s\n1.66\t0.573\n1.2\t0.4\n");
  ASSERT_THAT(read.set.rows, SizeIs(2));
  EXPECT_EQ(read.set.rows[1].line, 3);
  EXPECT_EQ(read.set.rows[1].initial_speed_mps, 1.2);
  EXPECT_EQ(read.set.rows[1].stop_time_s, 0.4);
}

TEST(CoastdownTrial, SetsARunFromRestAside) {
  const auto read = accepted(read_coastdown, "initial_speed_mps,stop_time_s\n0,0\n1.66,0.573\n");
  EXPECT_EQ(read.set.set_aside, 1);
  EXPECT_THAT(codes_of(read.findings), ElementsAre("rows-set-aside@2"));
}

TEST(CoastdownTrial, SaysThatACurveIsNotReadAndWhatIs) {
  EXPECT_THAT(faults_of(read_coastdown, "t_s,speed_mps\n0,1.66\n0.1,1.2\n"),
              ElementsAre(AllOf(StartsWith("1:1: "), HasSubstr("initial_speed_mps"),
                                HasSubstr("stop_time_s"))));
}

TEST(CoastdownTrial, NeedsItsColumns) {
  EXPECT_THAT(faults_of(read_coastdown, "initial_speed_mps\n1\n"),
              ElementsAre(HasSubstr("stop_time_s")));
  EXPECT_THAT(faults_of(read_coastdown, "speed\n1\n"), SizeIs(2));
}

TEST(CoastdownTrial, RefusesNegativeCellsAndAStopInNoTime) {
  EXPECT_THAT(
      faults_of(read_coastdown, "initial_speed_mps,stop_time_s\n-1.66,0.5\n1.66,-0.5\n1.66,0\n"),
      ElementsAre(StartsWith("2:1: "), StartsWith("3:6: "), StartsWith("4:6: ")));
}

}  // namespace
}  // namespace awmr
