/// Logs with signals of different rates, with several runs, and with time in other units.
#include <gmock/gmock.h>

#include <cmath>

#include "awmr/trials/read_trials.h"
#include "awmr/trials/replay.h"
#include "trial_text.h"

namespace awmr::testing::joined_log_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

std::string number(double value) { return std::to_string(value); }

/// Wide table with empty cells: a command every 40 ms, a speed every 10 ms with an offset of 3 ms,
/// and a position every 200 ms with an offset of 1 ms.
std::string wide_log(int rows = 400) {
  std::string text = "t_s,cmd.left,force_right,steering_cmd_deg,speed_mps,x_m,y_m,note\n";
  for (int ms = 0; ms < rows; ++ms) {
    const std::string t = number(1e-3 * ms);
    if (ms % 40 == 0) text += t + ",0." + (ms < 200 ? "2" : "3") + ",0.2,5,,,,\n";
    if (ms % 200 == 1) text += t + ",,,,," + number(0.01 * ms) + "," + number(0.02 * ms) + ",fix\n";
    if (ms % 10 == 3) text += t + ",,,," + number(1.0 + 1e-3 * ms * ms / 400.0) + ",,,\n";
    if (ms % 10 == 7) text += t + ",,,,,,,idle\n";
  }
  return text;
}

const TrialOptions kLeft{.columns = {*parse_column("force_left=cmd.left*2/2")}};

TEST(JoinedLog, CommandsHoldAndMeasurementsCountInTheirOwnRows) {
  const auto read = accepted(read_log, wide_log(), kLeft);
  const DrivingLog& log = read.set;
  EXPECT_TRUE(log.joined);
  // 10 commands, 40 speeds, 2 positions; rows with only a note are dropped.
  EXPECT_EQ(log.rows(), 52U);
  EXPECT_EQ(log[LogChannel::kSpeed]->fresh_count, 40);
  EXPECT_EQ(log[LogChannel::kX]->fresh_count, 2);
  EXPECT_EQ(log[LogChannel::kX]->fresh, log[LogChannel::kY]->fresh);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const int ms = static_cast<int>(std::lround(1e3 * log.t_s[i]));
    EXPECT_EQ(log.force_left[i], ms < 200 ? 0.2 : 0.3);
    EXPECT_EQ((*log.steering_command_rad)[i], (*log.steering_command_rad)[0]);
    EXPECT_EQ(log[LogChannel::kSpeed]->fresh[i], ms % 10 == 3);
    if (ms % 10 == 3) {
      EXPECT_NEAR(log[LogChannel::kSpeed]->value[i], 1.0 + 2.5e-6 * ms * ms, 1e-6);
    }
  }
  EXPECT_EQ(log.line[1], 3);
  EXPECT_THAT(codes_of(read.findings), Contains("joined-by-time@0"));
}

TEST(JoinedLog, ShortStepsBetweenSignalsMakeNoGaps) {
  const auto read = accepted(read_log, wide_log(4000), kLeft);
  EXPECT_THAT(codes_of(read.findings), Each(Not(StartsWith("log-gap"))));
  // Steps are weighted with their length. The steps of 10 ms between speeds cover most of the time,
  // the steps of 3 ms and 7 ms around the commands little.
  EXPECT_NEAR(read.set.median_step_s(), 10e-3, 1e-9);
  EXPECT_THAT(windows_of(read.set, 1.0), SizeIs(4));
}

TEST(JoinedLog, RowsBeforeEveryCommandIsKnownAreLeftOut) {
  std::string text = "t_s,force_left,force_right,steering_cmd_deg,speed_mps\n";
  for (int i = 0; i < 20; ++i) text += number(0.1 * i) + ",,,," + number(1.0 + 0.01 * i) + "\n";
  for (int i = 0; i < 20; ++i) {
    text += number(2.0 + 0.1 * i) + ",0.1,0.1,0,\n";
    text += number(2.05 + 0.1 * i) + ",,,," + number(1.5 + 0.01 * i * i) + "\n";
  }
  const auto read = accepted(read_log, text);
  EXPECT_EQ(read.set.rows(), 40U);
  EXPECT_DOUBLE_EQ(read.set.t_s.front(), 2.0);
  EXPECT_THAT(read.findings.front().message, HasSubstr("20 rows without a value"));
}

TEST(JoinedLog, AStrayEmptyCellIsAFaultAsBefore) {
  std::string text = "t_s,force_left,force_right,steering_cmd_deg,speed_mps\n";
  for (int i = 0; i < 20; ++i) {
    text += number(0.1 * i) + ",0.1,0.1,0," + (i == 7 ? "" : number(1.0 + 0.01 * i * i)) + "\n";
  }
  EXPECT_THAT(
      faults_of(read_log, text),
      ElementsAre(AllOf(StartsWith("9:"), HasSubstr("column speed_mps: the cell is empty"))));
}

TEST(JoinedLog, AnEmptyTimeIsAlwaysAFault) {
  std::string text = wide_log();
  text += ",,,,1.5,,,\n";
  EXPECT_THAT(faults_of(read_log, text, kLeft),
              ElementsAre(HasSubstr("column t_s: the cell is empty")));
}

TEST(JoinedLog, AColumnWithoutAnyValueIsRefused) {
  std::string text = "t_s,force_left,force_right,steering_cmd_deg,speed_mps,x_m\n";
  for (int i = 0; i < 20; ++i) {
    text += number(0.1 * i) + ",0.1,0.1,0," + number(1.0 + 0.01 * i * i) + ",\n";
  }
  EXPECT_THAT(faults_of(read_log, text),
              ElementsAre(HasSubstr("column x_m has no value in any row")));
}

TEST(JoinedLog, AFormulaHasAValueWhereItsFastestColumnHas) {
  std::string text = "t_s,duty,volts,force_right,steering_cmd_deg,speed_mps\n";
  for (int i = 0; i < 40; ++i) {
    const std::string t = number(0.1 * i);
    text += t + ",0.5," + (i % 10 == 0 ? number(12.0 - 0.1 * i) : "") + ",0.2,0," +
            number(1.0 + 0.01 * i * i) + "\n";
  }
  const auto read =
      accepted(read_log, text, {.columns = {*parse_column("force_left=duty*volts/12")}});
  EXPECT_NEAR(read.set.force_left[9], 0.5, 1e-12);
  EXPECT_NEAR(read.set.force_left[19], 0.5 * 11.0 / 12.0, 1e-12);
  EXPECT_NEAR(read.set.force_left[39], 0.5 * 9.0 / 12.0, 1e-12);
}

TEST(JoinedLog, ACommandThatIsNotRenewedForLongIsAWarning) {
  std::string text = "t_s,force_left,force_right,steering_cmd_deg,speed_mps\n";
  for (int i = 0; i < 200; ++i) {
    const std::string t = number(0.1 * i);
    text +=
        t + (i < 60 && i % 2 == 0 ? ",0.1,0.1,0," : ",,,,") + number(1.0 + 0.001 * i * i) + "\n";
  }
  const auto read = accepted(read_log, text);
  EXPECT_THAT(codes_of(read.findings), Contains("command-held@0"));
}

/// Two runs of this many rows each, the second with its own times.
std::string two_runs(int rows, bool numbered) {
  std::string text = std::string(numbered ? "run," : "") +
                     "t_s,force_left,force_right,steering_cmd_deg,speed_mps\n";
  for (int run = 1; run <= 2; ++run) {
    for (int i = 0; i < rows; ++i) {
      text += (numbered ? std::to_string(run) + "," : "") + number(0.1 * i) + ",0.1,0.1,0," +
              number(run + 0.01 * i * i) + "\n";
    }
  }
  return text;
}

TEST(RunsOfALog, AreSeparatedByTheirColumn) {
  const auto read = accepted(read_logs, two_runs(12, true));
  ASSERT_THAT(read.set, SizeIs(2));
  EXPECT_EQ(read.set[0].rows(), 12U);
  EXPECT_EQ(read.set[1].line.front(), 14);
  EXPECT_DOUBLE_EQ(read.set[1].t_s.front(), 0.0);
  EXPECT_DOUBLE_EQ(read.set[1][LogChannel::kSpeed]->value.front(), 2.0);
  EXPECT_THAT(read.findings, IsEmpty());
}

TEST(RunsOfALog, WithoutTheColumnTimeThatGoesBackIsRefusedWithTheRemedy) {
  EXPECT_THAT(faults_of(read_logs, two_runs(12, false)),
              ElementsAre(AllOf(StartsWith("14:"), HasSubstr("need a column run"))));
}

TEST(RunsOfALog, EachHasToBeLongEnough) {
  EXPECT_THAT(faults_of(read_logs, two_runs(9, true)),
              ElementsAre(HasSubstr("the run from line 2 has 9 rows"),
                          HasSubstr("the run from line 11 has 9 rows")));
}

TEST(RunsOfALog, RefuseAFileWithSeveralWhereOneIsRequested) {
  const ScratchFile file("log.csv", two_runs(12, true));
  std::vector<Finding> findings;
  const auto log = read_log(file.path(), {}, findings);
  ASSERT_FALSE(log);
  EXPECT_THAT(to_text(log.error()), HasSubstr("2 runs"));
}

TEST(LogFormat, IsReported) {
  std::string text = "# time_ms;force_left;force_right;steering_cmd_deg;speed_mps\r\n";
  for (int i = 0; i < 12; ++i) {
    text += std::to_string(100 * i) + ";0,1;0,1;0;1," + std::to_string(10 + i) + "\r\n";
  }
  const auto read = accepted(read_log, text);
  EXPECT_DOUBLE_EQ(read.set.t_s[3], 0.3);
  EXPECT_DOUBLE_EQ(read.set[LogChannel::kSpeed]->value[3], 1.13);
  EXPECT_THAT(codes_of(read.findings), ElementsAre("csv-format@1", "time-column@0"));
  EXPECT_THAT(read.findings[0].message,
              AllOf(HasSubstr("semicolons"), HasSubstr("decimal commas"), HasSubstr("after #")));
}

}  // namespace
}  // namespace awmr::testing::joined_log_test
