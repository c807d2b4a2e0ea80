#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "trial_text.h"

namespace awmr::testing::coastdown_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

using StopTimes = TrialSet<StopTimeRow>;
using Curves = std::vector<CoastCurve>;

TEST(CoastdownTrial, ReadsARowPerRun) {
  const auto read =
      accepted(read_coastdown, "initial_speed_mps\tstop_time_s\n1.66\t0.573\n1.2\t0.4\n");
  const auto& rows = std::get<StopTimes>(read.set).rows;
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_EQ(rows[1].line, 3);
  EXPECT_EQ(rows[1].initial_speed_mps, 1.2);
  EXPECT_EQ(rows[1].stop_time_s, 0.4);
}

TEST(CoastdownTrial, SetsARunFromRestAside) {
  const auto read = accepted(read_coastdown, "initial_speed_mps,stop_time_s\n0,0\n1.66,0.573\n");
  EXPECT_EQ(std::get<StopTimes>(read.set).set_aside, 1);
  EXPECT_THAT(codes_of(read.findings), ElementsAre("rows-set-aside@2"));
}

TEST(CoastdownTrial, ReadsCurvesByRun) {
  const auto read = accepted(read_coastdown,
                             "run,t_s,speed_mps\n1,0,1.6\n1,0.1,1.2\n1,0.2,0.8\n1,0.3,0.5\n1,0.4,"
                             "0.2\n2,0,1.5\n2,0.1,1.1\n2,0.2,0.7\n2,0.3,0.4\n2,0.4,-0.01\n");
  ASSERT_TRUE(std::holds_alternative<Curves>(read.set));
  const auto& curves = std::get<Curves>(read.set);
  ASSERT_THAT(curves, SizeIs(2));
  EXPECT_EQ(curves[1].line, 7);
  EXPECT_THAT(curves[1].speed_mps, ElementsAre(1.5, 1.1, 0.7, 0.4, -0.01));
}

TEST(CoastdownTrial, ReadsTheTimePerSpeedBinAsCurves) {
  const auto read = accepted(read_coastdown,
                             "from_mps,to_mps,elapsed_s\n1.5,1,0.2\n1,0.5,0.3\n0.5,0.25,0.25\n"
                             "1.5,1,0.25\n1,0.5,0.25\n");
  const auto& curves = std::get<Curves>(read.set);
  ASSERT_THAT(curves, SizeIs(2));
  EXPECT_THAT(curves[0].t_s, ElementsAre(0.0, 0.2, 0.5, 0.75));
  EXPECT_THAT(curves[0].speed_mps, ElementsAre(1.5, 1.0, 0.5, 0.25));
  EXPECT_EQ(curves[1].line, 5);
  EXPECT_THAT(curves[1].t_s, ElementsAre(0.0, 0.25, 0.5));
}

TEST(CoastdownTrial, RefusesSpeedBinsThatDoNotSlowDownOrAreIncomplete) {
  EXPECT_THAT(faults_of(read_coastdown, "from_mps,to_mps,elapsed_s\n1,1.5,0.2\n1.5,1,0\n1,0,1\n"),
              ElementsAre(StartsWith("2:3: "), StartsWith("3:7: ")));
  EXPECT_THAT(faults_of(read_coastdown, "from_mps,elapsed_s\n1,0.2\n"),
              ElementsAre(HasSubstr("from_mps, to_mps and elapsed_s")));
  EXPECT_THAT(faults_of(read_coastdown, "from_mps,to_mps,elapsed_s\n1.5,1,0.2\n"),
              ElementsAre(HasSubstr("2 speeds")));
  EXPECT_THAT(faults_of(read_coastdown, "from_mps,to_mps,elapsed_s,t_s,speed_mps\n1,0.5,0.2,0,1\n"),
              ElementsAre(HasSubstr("two files")));
}

TEST(CoastdownTrial, RefusesBothFormsInOneFile) {
  EXPECT_THAT(faults_of(read_coastdown,
                        "t_s,speed_mps,initial_speed_mps,stop_time_s\n0,1,1,1\n0.1,1,1,1\n"),
              ElementsAre(HasSubstr("two files")));
  EXPECT_THAT(faults_of(read_coastdown, "t_s,initial_speed_mps\n0,1\n"),
              ElementsAre(HasSubstr("speed_mps")));
}

TEST(CoastdownTrial, DerivesTheErrorOfATimeFromItsDigits) {
  // Standard deviation: 0.1 s for a stop watch; for times to the millisecond, which are taken
  // automatically, that of rounding, 1 ms/sqrt(12).
  const auto timing_std_s = [](const std::string& row) {
    const auto read = accepted(read_coastdown, "initial_speed_mps,stop_time_s\n" + row + "\n");
    return std::get<StopTimes>(read.set).rows[0].timing_std_s;
  };
  EXPECT_EQ(timing_std_s("1.66,0.57"), 0.1);
  EXPECT_NEAR(timing_std_s("1.66,0.573"), 1e-3 / std::sqrt(12.0), 1e-9);
}

}  // namespace
}  // namespace awmr::testing::coastdown_test
