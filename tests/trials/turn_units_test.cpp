/// Wrong units of yaw rates are reported before any fit; realistic vehicles are never refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "awmr/trials/load.h"
#include "random_campaign.h"
#include "trial_text.h"

namespace awmr::testing::turn_units_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kDegree = 57.29577951308232;
constexpr double kPerMinute = 9.549296585513721;
constexpr Drive kDrives[] = {Drive::kFourWheel, Drive::kFrontWheel, Drive::kDifferential};

/// Returns the text of the refusal of tables, with or without surge runs; empty if they are
/// accepted.
std::string refusal_of(const Vehicle& vehicle, const std::string& surge,
                       const std::string& turning) {
  const ScratchFile surge_file("surge.csv", surge);
  const ScratchFile turning_file("turning.csv", turning);
  TrialFiles files{.turning = turning_file.path()};
  if (!surge.empty()) files.surge = surge_file.path();
  const auto trials = load_trials(vehicle, files);
  return trials ? "" : to_text(trials.error());
}

/// Counts the random campaigns (vehicle and tables) that are refused with `words` if all yaw rates
/// are multiplied by `factor`.
int named(Drive drive, double factor, bool with_surge, int campaigns, std::string_view words) {
  int count = 0;
  for (int i = 0; i < campaigns; ++i) {
    const auto seed = static_cast<std::uint64_t>(1000 * static_cast<int>(drive) + i);
    const Campaign made = CampaignDraw(seed, drive, factor).campaign();
    const std::string refused =
        refusal_of(made.vehicle, with_surge ? made.surge : "", made.turning);
    if (factor == 1.0) {
      EXPECT_THAT(refused, IsEmpty()) << made.surge << made.turning;
    }
    count += refused.find(words) != std::string::npos ? 1 : 0;
  }
  return count;
}

/// The paper's Table 3 with all yaw rates multiplied by `factor`.
std::string paper_turns(double factor) {
  std::string text = "steering_deg,wheel_force,yaw_rate_radps\n";
  const std::pair<double, double> runs[] = {{5, 0.038}, {10, 0.088}, {15, 0.15}, {20, 0.22}};
  for (const auto& [angle, rate] : runs) {
    text += fmt::format("{},0.35,{:.5g}\n", angle, factor * rate);
  }
  return text;
}
const std::string kPaperSurge = "tau_speed,speed_mps\n0.6,0.39\n1,0.72\n1.4,1.03\n2,1.66\n";

TEST(TurnUnits, AWholeTableInDegreesPerSecondIsNamedWithTheUnitFix) {
  for (const std::string& surge : {kPaperSurge, std::string()}) {
    EXPECT_EQ(refusal_of(paper_vehicle(), surge, paper_turns(1.0)), "");
    EXPECT_THAT(refusal_of(paper_vehicle(), surge, paper_turns(kDegree)),
                AllOf(HasSubstr("turning.csv:2"), HasSubstr("degrees per second"),
                      HasSubstr("yaw_rate_radps=\"yaw_rate_radps\"*0.01745329")));
  }
  EXPECT_THAT(refusal_of(paper_vehicle(), kPaperSurge, paper_turns(1.0 / kDegree)),
              HasSubstr("yaw_rate_radps=\"yaw_rate_radps\"*57.29578"));
}

TEST(TurnUnits, TurnsAndTimesOfOtherUnitsAreNamed) {
  const std::string columns = "steering_deg,wheel_force,turns,elapsed_s\n";
  const auto refused = [&](const std::string& rows) {
    return refusal_of(paper_vehicle(), kPaperSurge, columns + rows);
  };
  // One turn in 71.4 s and in 28.56 s: 0.088 and 0.22 rad/s.
  EXPECT_EQ(refused("10,0.35,1,71.4\n20,0.35,1,28.56\n"), "");
  EXPECT_THAT(refused("10,0.35,360,71.4\n20,0.35,360,28.56\n"),
              HasSubstr("turns=\"turns\"*0.002777778"));
  EXPECT_THAT(refused("10,0.35,1,1.19\n20,0.35,1,0.476\n"),
              HasSubstr("elapsed_s=\"elapsed_s\"*60"));
}

TEST(TurnUnits, TheRowsBeyondGripAreNamedWhereTheColumnIsRight) {
  const std::string wrong_row = paper_turns(1.0) + "20,0.35,12.6\n";
  EXPECT_THAT(
      refusal_of(paper_vehicle(), kPaperSurge, wrong_row),
      AllOf(HasSubstr("turning.csv:6"), HasSubstr("correct line 6"), Not(HasSubstr("map it"))));
}

TEST(TurnUnits, ForcesInPwmCountsOfBothTablesGiveSpeeds) {
  const std::string surge = "wheel_force,speed_mps\n51,0.55\n102,1.26\n153,2\n255,3.2\n";
  std::string turning = "steering_deg,wheel_force,yaw_rate_radps\n10,89,5.04\n20,89,12.6\n";
  EXPECT_THAT(refusal_of(paper_vehicle(), surge, turning),
              AllOf(HasSubstr("8-bit PWM counts"), HasSubstr("degrees per second")));
}

TEST(TurnUnits, AnAngleInRadiansIsNotTakenForARateInDegrees) {
  const std::string refused =
      refusal_of(paper_vehicle(), kPaperSurge,
                 "steering_deg,wheel_force,yaw_rate_radps\n0.17,0.35,0.088\n0.35,0.35,0.22\n");
  EXPECT_THAT(refused, AllOf(HasSubstr("radians"), Not(HasSubstr("yaw rates"))));
}

TEST(TurnUnits, APrintedMomentWithoutAnAngleDoesNotBoundTheRate) {
  EXPECT_EQ(refusal_of(paper_vehicle(), kPaperSurge,
                       "steering_deg,wheel_force,yaw_rate_radps,tau_turn\n10,0.35,0.088,0.042\n"
                       "20,0.35,0.22,0.086\n0,0.35,0.05,0.02\n"),
            "");
}

/// Computes the bounds independently, by the formulas of CHECKS.md.
TEST(TurnUnits, TheBoundsAreTheDocumentedOnes) {
  const std::string surge = "wheel_force,speed_mps\n0.2,0.5\n0.4,1.0\n0.8,3.0\n";
  const double tan20 = std::tan(std::acos(-1.0) / 9.0);
  const auto steered = [&](double rate) {
    return refusal_of(paper_vehicle(), surge,
                      fmt::format("steering_deg,wheel_force,yaw_rate_radps\n20,0.6,{}\n", rate));
  };
  // u(0.6) = 2 m/s lies halfway between two surge runs. With l_f = 0.35 m, yaw rates of up to three
  // times u tan(d)/l_f, that is, 6.24 rad/s, are accepted.
  const double rolled = 2.0 * tan20 / 0.35;
  EXPECT_EQ(steered(2.95 * rolled), "");
  EXPECT_THAT(steered(3.05 * rolled), HasSubstr("2 m/s of the surge runs"));
  EXPECT_EQ(steered(0.011 * rolled), "");
  EXPECT_THAT(steered(0.009 * rolled), HasSubstr("*57.29578"));

  Vehicle sides = paper_vehicle();
  sides.drive = Drive::kDifferential;
  const auto by_sides = [&](double rate) {
    return refusal_of(sides, surge,
                      fmt::format("force_left,force_right,yaw_rate_radps\n-0.2,0.6,{}\n", rate));
  };
  // The speeds of the two sides differ by 2 - (-0.5) m/s, so rolling wheels turn at 2.5/(2 0.36) =
  // 3.47 rad/s. Up to four times this rate is accepted.
  EXPECT_EQ(by_sides(3.95 * 2.5 / 0.72), "");
  EXPECT_THAT(by_sides(4.05 * 2.5 / 0.72), HasSubstr("differ by 2.5 m/s"));

  const auto without = [&](double rate) {
    return refusal_of(paper_vehicle(), "",
                      fmt::format("steering_deg,wheel_force,yaw_rate_radps\n20,0.6,{}\n", rate));
  };
  // The lateral acceleration r^2 l_f/tan(20 deg) may be at most 60 m/s^2, with l_f = 0.35 m.
  const double grip = std::sqrt(60.0 * tan20 / 0.35);
  EXPECT_EQ(without(0.99 * grip), "");
  EXPECT_THAT(without(1.01 * grip), HasSubstr("grip"));
  const auto sides_without = [&](double rate) {
    return refusal_of(sides, "",
                      fmt::format("force_left,force_right,yaw_rate_radps\n-0.2,0.6,{}\n", rate));
  };
  EXPECT_EQ(sides_without(24.9), "");
  EXPECT_THAT(sides_without(25.1), HasSubstr("faster than 25 rad/s"));
}

/// 200 vehicles of each drive, with and without surge runs: 1200 campaigns.
TEST(TurnUnits, NoGoodTableIsRefused) {
  for (const Drive drive : kDrives) {
    for (const bool with_surge : {true, false}) {
      EXPECT_EQ(named(drive, 1.0, with_surge, 200, "error"), 0);
    }
  }
}

/// The random campaigns are reproducible, so the counts are the same in every run.
TEST(TurnUnits, WrongTablesOfDrawnVehiclesAreNamed) {
  constexpr int kCampaigns = 50;
  for (const Drive drive : kDrives) {
    EXPECT_EQ(named(drive, kDegree, true, kCampaigns, "*0.01745329"), kCampaigns);
    EXPECT_GE(named(drive, kDegree, false, kCampaigns, "*0.01745329"), 7 * kCampaigns / 10);
    EXPECT_GE(named(drive, kPerMinute, true, kCampaigns, "*0.1047198"), 6 * kCampaigns / 10);
    if (drive == Drive::kDifferential) continue;
    EXPECT_GE(named(drive, 1.0 / kDegree, true, kCampaigns, "*57.29578"), 8 * kCampaigns / 10);
  }
}

}  // namespace
}  // namespace awmr::testing::turn_units_test
