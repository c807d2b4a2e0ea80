/// Reading and combining trial files.
#include "awmr/trials/load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "steady_log.h"
#include "trial_text.h"

namespace awmr::testing::load_test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

const std::filesystem::path kPaper = AWMR_SOURCE_DIR "/datasets/paper";
const std::filesystem::path kSynthetic = AWMR_SOURCE_DIR "/datasets/synthetic";

TrialFiles paper_files() {
  return {.surge = kPaper / "surge.csv",
          .turning = kPaper / "turning.csv",
          .coastdowns = {kPaper / "coastdown.csv"}};
}

/// Returns the error text for a surge or turning table with these rows. If the table is accepted,
/// returns its warning with `as_is`, else an empty text.
std::string refusal_of(const std::string& name, const std::string& text, bool as_is = false) {
  const ScratchFile file(name, text);
  TrialFiles files{.options = {.columns = {}, .as_is = as_is}};
  (name == "surge.csv" ? files.surge : files.turning) = file.path();
  const auto trials = load_trials(paper_vehicle(), files);
  if (!trials) return to_text(trials.error());
  for (const Finding& finding : trials->findings) {
    if (finding.code == "table-contradiction") return "warned: " + finding.message;
  }
  return "";
}

TEST(LoadTrials, ForcesBeyondTheVehiclesAreRefusedWithTheLikelyUnit) {
  EXPECT_THAT(refusal_of("surge.csv", "tau_speed,speed_mps\n4,0.5\n80,0.9\n100,1.2\n"),
              AllOf(HasSubstr(":3"), HasSubstr("beyond 4 F'max = 4"), HasSubstr("percent"),
                    HasSubstr("tau_speed=\"tau_speed\"*0.01")));
  EXPECT_THAT(refusal_of("surge.csv", "wheel_force,speed_mps\n90,0.5\n180,0.9\n255,1.2\n"),
              AllOf(HasSubstr(":2"), HasSubstr("8-bit PWM"), HasSubstr("wheel_force=")));
  EXPECT_THAT(
      refusal_of("turning.csv", "steering_deg,wheel_force,yaw_rate_radps\n10,35,0.1\n20,35,0.2\n"),
      AllOf(HasSubstr("percent"), HasSubstr("wheel_force=\"wheel_force\"*0.01")));
  EXPECT_EQ(refusal_of("surge.csv", "tau_speed,speed_mps\n1,0.5\n2,0.9\n4,1.2\n"), "");
  EXPECT_THAT(refusal_of("surge.csv", "tau_speed,speed_mps\n4,0.5\n80,0.9\n100,1.2\n", true),
              HasSubstr("warned"));
}

TEST(LoadTrials, SteeringInRadiansIsRefused) {
  EXPECT_THAT(refusal_of("turning.csv",
                         "steering_deg,wheel_force,yaw_rate_radps\n0.17,0.35,0.1\n0.35,0.35,0.2\n"),
              AllOf(HasSubstr("radians"), HasSubstr("steering_deg=\"steering_deg\"*57.29")));
}

TEST(LoadTrials, SpeedsAndTimesInOtherUnitsAreRefusedWithTheUnitFix) {
  // The same three runs, 0.5, 1 and 2 m/s over 10 m, in common notations.
  const std::pair<const char*, const char*> cases[] = {
      {"tau_speed,speed_mps,distance_m,elapsed_s\n1,1.8,10,20\n2,3.6,10,10\n4,7.2,10,5\n",
       "speed_mps=\"speed_mps\"*0.2777778"},
      {"tau_speed,speed_mps,distance_m,elapsed_s\n1,500,10,20\n2,1000,10,10\n4,2000,10,5\n",
       "speed_mps=\"speed_mps\"*0.001"},
      {"tau_speed,speed_mps,distance_m,elapsed_s\n1,0.5,10,20000\n2,1,10,10000\n4,2,10,5000\n",
       "elapsed_s=\"elapsed_s\"*0.001"},
      {"tau_speed,speed_mps,distance_m,elapsed_s\n1,0.5,1000,20\n2,1,1000,10\n4,2,1000,5\n",
       "distance_m=\"distance_m\"*0.01"},
      {"tau_speed,distance_m,elapsed_s\n1,10,20000\n2,10,10000\n4,10,5000\n",
       "elapsed_s=\"elapsed_s\"*0.001"},
      {"tau_speed,distance_m,elapsed_s\n1,1000,20\n2,1000,10\n4,1000,5\n",
       "distance_m=\"distance_m\"*0.01"},
      {"tau_speed,distance_m,elapsed_s\n1,10000,20\n2,10000,10\n4,10000,5\n",
       "distance_m=\"distance_m\"*0.001"},
      {"tau_speed,speed_mps\n1,50\n2,100\n4,200\n", "speed_mps=\"speed_mps\"*0.01"}};
  for (const auto& [text, mapping] : cases) {
    EXPECT_THAT(refusal_of("surge.csv", text), HasSubstr(mapping)) << text;
  }
  EXPECT_EQ(
      refusal_of("surge.csv", "tau_speed,speed_mps,distance_m,elapsed_s\n1,0.5,10,20\n4,2,10,5\n"),
      "");
}

TEST(LoadTrials, TurnsInOtherUnitsAreRefusedWithTheUnitFix) {
  const std::string columns = "steering_deg,wheel_force,yaw_rate_radps,turns,elapsed_s\n";
  EXPECT_EQ(refusal_of("turning.csv", columns + "10,0.3,0.1,1,62.83\n20,0.3,0.2,1,31.42\n"), "");
  EXPECT_THAT(refusal_of("turning.csv", columns + "10,0.3,5.73,1,62.83\n20,0.3,11.46,1,31.42\n"),
              HasSubstr("yaw_rate_radps=\"yaw_rate_radps\"*0.0174532"));
  EXPECT_THAT(refusal_of("turning.csv", columns + "10,0.3,0.1,1,62830\n20,0.3,0.2,1,31420\n"),
              HasSubstr("elapsed_s=\"elapsed_s\"*0.001"));
  EXPECT_THAT(
      refusal_of("turning.csv",
                 "steering_deg,wheel_force,turns,elapsed_s\n10,0.3,1,62830\n20,0.3,1,31420\n"),
      HasSubstr("milliseconds"));
}

TEST(LoadTrials, AStopInMillisecondsIsRefused) {
  const ScratchFile file("coastdown.csv", "initial_speed_mps,stop_time_s\n1.2,900\n0.8,700\n");
  const auto trials = load_trials(paper_vehicle(), {.coastdowns = {file.path()}});
  ASSERT_FALSE(trials);
  EXPECT_THAT(to_text(trials.error()),
              AllOf(HasSubstr("milliseconds"), HasSubstr("stop_time_s=\"stop_time_s\"*0.001")));
}

TEST(LoadTrials, AStopInMinutesIsRefused) {
  const ScratchFile file("coastdown.csv", "initial_speed_mps,stop_time_s\n1.5,0.0233\n3,0.03\n");
  TrialFiles files{.coastdowns = {file.path()}};
  const auto trials = load_trials(paper_vehicle(), files);
  ASSERT_FALSE(trials);
  EXPECT_THAT(to_text(trials.error()),
              AllOf(HasSubstr("minutes"), HasSubstr("stop_time_s=\"stop_time_s\"*60")));
  // If only one of several runs has a wrong value, the unit of the column is not in doubt and the
  // table is accepted.
  const ScratchFile one("coastdown.csv", "initial_speed_mps,stop_time_s\n1.5,1.4\n3,0.03\n");
  files.coastdowns = {one.path()};
  EXPECT_TRUE(load_trials(paper_vehicle(), files));
}

TEST(LoadTrials, ReportsCoastDownsThatAllBeginFarBelowTheFastestRun) {
  const ScratchFile surge("surge.csv", "tau_speed,speed_mps\n1,1.5\n2,5\n4,15\n");
  const ScratchFile slow("coastdown.csv", "initial_speed_mps,stop_time_s\n1.5,1.4\n3,1.8\n");
  const ScratchFile fast("coastdown.csv", "initial_speed_mps,stop_time_s\n1.5,1.4\n6,2.5\n");
  TrialFiles files{.surge = surge.path(), .coastdowns = {slow.path()}};
  const auto reported = load_trials(paper_vehicle(), files);
  ASSERT_TRUE(reported) << to_text(reported.error());
  EXPECT_THAT(codes_of(reported->findings), Contains("coast-below-surge@3"));
  files.coastdowns = {fast.path()};
  const auto accepted = load_trials(paper_vehicle(), files);
  ASSERT_TRUE(accepted) << to_text(accepted.error());
  EXPECT_THAT(codes_of(accepted->findings), Not(Contains(HasSubstr("coast-below-surge"))));
}

TEST(LoadTrials, ACoastDownThatBeginsFasterThanTheSurgeRunsAllowIsRefusedWithTheLikelyUnit) {
  const ScratchFile file("coastdown.csv", "initial_speed_mps,stop_time_s\n5.98,0.573\n");
  TrialFiles files{.surge = kPaper / "surge.csv"};
  Vehicle vehicle = paper_vehicle();
  vehicle.wheel_force = {0.0, 0.5};  // force of the fastest run
  files.coastdowns = {file.path()};
  const auto trials = load_trials(vehicle, files);
  ASSERT_FALSE(trials);
  EXPECT_THAT(to_text(trials.error()),
              AllOf(HasSubstr("begins at 5.98 m/s"), HasSubstr("looks like km/h"),
                    HasSubstr("initial_speed_mps=\"initial_speed_mps\"*0.2777778")));
  files.options.as_is = true;
  EXPECT_TRUE(load_trials(vehicle, files));
  // 1.9 m/s is accepted: it exceeds the fastest run, 1.66 m/s, but by less than the margin of 30 %,
  // as in a coast-down that begins downhill.
  files.options.as_is = false;
  const ScratchFile fast("coastdown.csv", "initial_speed_mps,stop_time_s\n1.9,0.6\n");
  files.coastdowns = {fast.path()};
  EXPECT_TRUE(load_trials(vehicle, files));
}

TEST(LoadTrials, AVehicleWithImpossibleSizesDoesNotBoundSpeeds) {
  const ScratchFile file("surge.csv", "tau_speed,distance_m,elapsed_s\n1,10,20\n4,10,5\n");
  TrialFiles files{.surge = file.path()};
  Vehicle vehicle = paper_vehicle();
  vehicle.length_m = 780.0;
  EXPECT_TRUE(load_trials(vehicle, files));
}

TEST(LoadTrials, ReadsTheGivenFilesAndKeepsFindingsInOrder) {
  const auto trials = load_trials(paper_vehicle(), paper_files());
  ASSERT_TRUE(trials) << to_text(trials.error());
  EXPECT_EQ(trials->vehicle.front_axle_m, 0.35);
  EXPECT_THAT(trials->data.surge->rows, SizeIs(10));
  EXPECT_THAT(trials->data.turning->rows, SizeIs(5));
  EXPECT_TRUE(trials->data.coastdown);
  EXPECT_TRUE(trials->data.logs.empty());
  std::vector<Finding> expected;
  ASSERT_TRUE(read_surge(kPaper / "surge.csv", {}, expected));
  ASSERT_TRUE(read_turning(kPaper / "turning.csv", paper_vehicle(), {}, expected));
  ASSERT_TRUE(read_coastdown(kPaper / "coastdown.csv", {}, expected));
  EXPECT_EQ(codes_of(trials->findings), codes_of(expected));
}

TEST(LoadTrials, CurvesAndStopTimesOfSeveralFilesComeTogether) {
  TrialFiles files = paper_files();
  const ScratchFile curve("curve.csv", "t_s,speed_mps\n0,1\n0.1,0.8\n0.2,0.7\n");
  files.coastdowns = {kSynthetic / "coastdown.csv", kPaper / "coastdown.csv", curve.path()};
  const auto trials = load_trials(paper_vehicle(), files);
  ASSERT_TRUE(trials) << to_text(trials.error());
  EXPECT_TRUE(trials->data.coastdown);
  EXPECT_THAT(trials->data.curves, SizeIs(4));  // three of the synthetic file
}

TEST(LoadTrials, ASecondFileOfStopTimesIsRefused) {
  TrialFiles files = paper_files();
  files.coastdowns.push_back(kPaper / "coastdown.csv");
  const auto trials = load_trials(paper_vehicle(), files);
  ASSERT_FALSE(trials);
  EXPECT_THAT(to_text(trials.error()), HasSubstr("a second file of stop times"));
}

TEST(LoadTrials, TheFaultsOfAllFilesComeTogether) {
  const auto trials = load_trials(paper_vehicle(), {.surge = "/no/surge.csv",
                                                    .turning = "/no/turning.csv",
                                                    .coastdowns = {"/no/coastdown.csv"},
                                                    .logs = {"/no/log.csv"}});
  ASSERT_FALSE(trials);
  std::vector<std::string> places;
  for (const Fault& fault : trials.error().faults) places.push_back(fault.place);
  EXPECT_THAT(places,
              ElementsAre("/no/surge.csv", "/no/turning.csv", "/no/coastdown.csv", "/no/log.csv"));
}

TEST(LoadTrials, NoFileAndSteadyRunsWithoutALogAreRefused) {
  EXPECT_THAT(to_text(load_trials(paper_vehicle(), {}).error()), HasSubstr("no trials"));
  TrialFiles files = paper_files();
  files.steady_from_logs = true;
  EXPECT_THAT(to_text(load_trials(paper_vehicle(), files).error()), HasSubstr("no log was given"));
}

TEST(LoadTrials, SteadyRunsOfALogJoinTheRowsOfATable) {
  const ScratchFile log("steady.csv", steady_log_text());
  TrialFiles files = paper_files();
  files.logs = {log.path()};
  files.steady_from_logs = true;
  const auto trials = load_trials(paper_vehicle(), files);
  ASSERT_TRUE(trials) << to_text(trials.error());
  EXPECT_THAT(trials->data.logs, SizeIs(1));
  // Surge: ten rows of the table and one from the log. Turning: five and one.
  EXPECT_THAT(trials->data.surge->rows, SizeIs(11));
  EXPECT_THAT(trials->data.turning->rows, SizeIs(6));
  EXPECT_EQ(trials->data.surge->file, "surge.csv");
}

}  // namespace
}  // namespace awmr::testing::load_test
