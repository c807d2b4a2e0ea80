/// Forces in other units: one unit for all tables, and none if the unit is unclear.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "awmr/trials/load.h"
#include "trial_text.h"

namespace awmr::testing::force_units_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Returns the error text for these tables (each may be empty) and a vehicle with this wheel_force.
std::string refusal_of(const std::string& surge, const std::string& turning,
                       const Interval& wheel_force = {-1.0, 1.0},
                       std::vector<ColumnMapping> columns = {}) {
  const ScratchFile surge_file("surge.csv", surge);
  const ScratchFile turning_file("turning.csv", turning);
  TrialFiles files{.options = {.columns = std::move(columns)}};
  Vehicle vehicle = paper_vehicle();
  vehicle.wheel_force = wheel_force;
  if (!surge.empty()) files.surge = surge_file.path();
  if (!turning.empty()) files.turning = turning_file.path();
  const auto trials = load_trials(vehicle, files);
  return trials ? "" : to_text(trials.error());
}

const std::string kTurns = "steering_deg,wheel_force,yaw_rate_radps,force_left,force_right\n";

TEST(ForceUnits, TheLargestForceOfAllTablesDecidesForEachColumn) {
  const std::string refused =
      refusal_of("wheel_force,speed_mps\n40,0.39\n70,0.72\n97,1.03\n",
                 kTurns + "10,89,0.088,,\n20,89,0.22,,\n0,,0.2,40,255\n0,,0.1,60,200\n");
  EXPECT_THAT(refused, AllOf(HasSubstr("force_left=\"force_left\"*0.003921569"),
                             HasSubstr("force_right=\"force_right\"*0.003921569"),
                             HasSubstr("turning.csv:2: wheel_force is 89"),
                             HasSubstr("surge.csv:2: tau_speed is"), Not(HasSubstr("percent"))));
  // One mapping corrects the column wheel_force of both tables.
  const std::string mapping = "wheel_force=\"wheel_force\"*0.003921569";
  EXPECT_NE(refused.find(mapping), refused.rfind(mapping));
}

TEST(ForceUnits, TauSpeedIsFourTimesTheForceOfAWheel) {
  const std::string turns = kTurns + "10,89,0.088,,\n0,,0.2,0,255\n";
  // Values up to 255 may be one wheel's counts or the sum of four; larger ones are the sum.
  EXPECT_THAT(refusal_of("tau_speed,speed_mps\n102,0.55\n255,1.66\n", turns),
              AllOf(HasSubstr("tau_speed=\"tau_speed\"*0.01568627"),
                    HasSubstr("tau_speed=\"tau_speed\"*0.003921569")));
  EXPECT_THAT(refusal_of("tau_speed,speed_mps\n300,0.55\n800,1.66\n", turns),
              AllOf(Not(HasSubstr("0.01568627")),
                    HasSubstr("tau_speed=\"tau_speed\"*0.003921569', or accept it")));
  // 400 means four wheels at 100 %; no scale ends at 400.
  EXPECT_THAT(refusal_of("tau_speed,speed_mps\n300,0.55\n400,1.66\n", ""),
              AllOf(HasSubstr("look like percent;"),
                    HasSubstr("tau_speed=\"tau_speed\"*0.01', or accept it")));
}

TEST(ForceUnits, MicrosecondsOfAServoPulseHaveAnOffset) {
  const std::string surge =
      "wheel_force,speed_mps\n1500,0\n1600,0.28\n1700,0.55\n1850,1.03\n2000,1.66\n";
  EXPECT_THAT(refusal_of(surge, ""), AllOf(HasSubstr("F' = (us - 1500)/500"),
                                           HasSubstr("wheel_force=\"wheel_force\"*0.002-3")));
  EXPECT_THAT(refusal_of("tau_speed,speed_mps\n1600,0.28\n2000,1.66\n", ""),
              HasSubstr("tau_speed=\"tau_speed\"*0.008-12"));
  EXPECT_THAT(refusal_of("", kTurns + "0,,0.2,1400,1600\n0,,0.3,1350,1900\n"),
              AllOf(HasSubstr("force_left=\"force_left\"*0.002-3"),
                    HasSubstr("force_right=\"force_right\"*0.002-3")));
  // The suggested mapping corrects the values, and includes an existing mapping.
  EXPECT_EQ(
      refusal_of(surge, "", {-1.0, 1.0}, {*parse_column("wheel_force=\"wheel_force\"*0.002-3")}),
      "");
  EXPECT_THAT(refusal_of("ms,speed_mps\n0.6,0.28\n1.0,1.66\n", "", {-1.0, 1.0},
                         {*parse_column("wheel_force=ms*1000+1000")}),
              HasSubstr("wheel_force=\"ms\"*2-1'"));
  // The values are PWM counts: servo pulses are not shorter than 900 us.
  EXPECT_THAT(refusal_of("wheel_force,speed_mps\n500,0.28\n2000,1.66\n", ""),
              Not(HasSubstr("microseconds")));
}

TEST(ForceUnits, NamesAllUnitsIfNoneIsClear) {
  // 89 is 89 % or 35 % of 255, and four times 89 N accelerate 37 kg by 9.6 m/s^2.
  EXPECT_THAT(refusal_of("wheel_force,speed_mps\n40,0.55\n89,1.66\n", ""),
              AllOf(HasSubstr("percent, 8-bit PWM counts or newtons"),
                    HasSubstr("wheel_force=\"wheel_force\"*0.01' (percent)"),
                    HasSubstr("wheel_force=\"wheel_force\"*0.003921569' (8-bit PWM counts)")));
  // The mapping is shown with its unit even if the other possible units have no mapping.
  EXPECT_THAT(refusal_of("wheel_force,speed_mps\n20,0.55\n38,1.66\n", ""),
              AllOf(HasSubstr("percent, volts"), HasSubstr("newtons"),
                    HasSubstr("wheel_force=\"wheel_force\"*0.01' (percent), or accept it")));
  // 12 is below a fifth of the end of every scale, so it can be volts or newtons, whose factors are
  // unknown.
  EXPECT_THAT(refusal_of("wheel_force,speed_mps\n4,0.55\n12,1.66\n", ""),
              AllOf(HasSubstr("volts"), HasSubstr("newtons"), Not(HasSubstr("map it")),
                    Not(HasSubstr("percent"))));
  // The values are not newtons: 4 times 1023 N would accelerate the vehicle by 111 m/s^2.
  EXPECT_THAT(refusal_of("wheel_force,speed_mps\n300,0.55\n800,1.66\n", ""),
              Not(HasSubstr("newtons")));
}

TEST(ForceUnits, ForcesUpToOneBeyondANarrowWheelForceAreNoUnit) {
  const std::string surge = "wheel_force,speed_mps\n0.3,0.55\n0.89,1.66\n";
  EXPECT_THAT(refusal_of(surge, "", {0.0, 0.5}),
              AllOf(HasSubstr("raise wheel_force in vehicle.json to 0.89"),
                    HasSubstr("wheel_force=\"wheel_force\"*0.5'"), Not(HasSubstr("percent"))));
  EXPECT_EQ(refusal_of(surge, "", {0.0, 0.9}), "");
  EXPECT_THAT(refusal_of("tau_speed,speed_mps\n1,0.55\n3.56,1.66\n", "", {0.0, 0.5}),
              AllOf(HasSubstr("raise wheel_force in vehicle.json to 0.89"),
                    HasSubstr("tau_speed=\"tau_speed\"*0.5'")));
}

TEST(ForceUnits, ConvertsOnlyThePercentNextToRightForces) {
  const std::string refused = refusal_of("wheel_force,speed_mps\n0.3,0.55\n0.9,1.66\n",
                                         kTurns + "10,50,0.088,,\n20,100,0.22,,\n");
  EXPECT_THAT(refused, AllOf(Not(HasSubstr("surge.csv")), HasSubstr("percent")));
}

}  // namespace
}  // namespace awmr::testing::force_units_test
