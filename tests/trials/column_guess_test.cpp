/// Guesses for the columns of a file: confidence, open columns, and reasons.
#include "awmr/trials/column_guess.h"

#include <gmock/gmock.h>

#include "awmr/core/column_mapping.h"
#include "support/scratch_file.h"

namespace awmr::testing::column_guess_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Returns the text `CONFIDENCE COLUMN=EXPRESSION` for each guess.
std::vector<std::string> guesses_of(const std::string& text, TrialKind kind = TrialKind::kLog,
                                    std::optional<double> track_m = std::nullopt) {
  const ScratchFile file("a.csv", text);
  const auto sample = sample_of(file.path());
  if (!sample) return {to_text(sample.error())};
  std::vector<std::string> all;
  for (const ColumnGuess& guess : guess_columns(*sample, kind, track_m)) {
    all.push_back(std::string(name_in(kConfidenceNames, guess.confidence)) + " " + guess.column +
                  "=" + guess.expression);
    EXPECT_FALSE(guess.why.empty());
    if (!guess.expression.empty() && guess.column != guess.expression) {
      EXPECT_TRUE(parse_column(guess.column + "=" + guess.expression)) << guess.expression;
    }
  }
  return all;
}

TEST(GuessColumns, TakesTheNamesThatAreRequested) {
  EXPECT_THAT(
      guesses_of("t_s,force_left,speed_mps\n0,0.1,1\n"),
      ElementsAre("sure t_s=t_s", "sure force_left=force_left", "sure speed_mps=speed_mps"));
}

TEST(GuessColumns, AChannelThatIsConstantWhileOthersMoveIsNotProposed) {
  std::string text = "t_s,odom.twist.twist.linear.x,odom.twist.twist.linear.y\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(i) + "," + std::to_string(0.1 * i) + ",0\n";
  EXPECT_THAT(guesses_of(text),
              ElementsAre("sure t_s=t_s", "likely speed_mps=odom.twist.twist.linear.x",
                          "unsure sway_mps="));
  std::string at_rest = "t_s,odom.twist.twist.linear.x,odom.twist.twist.linear.y\n";
  for (int i = 0; i < 20; ++i) at_rest += std::to_string(i) + ",0,0\n";
  EXPECT_THAT(guesses_of(at_rest),
              ElementsAre("sure t_s=t_s", "likely speed_mps=odom.twist.twist.linear.x",
                          "likely sway_mps=odom.twist.twist.linear.y"));
}

TEST(GuessColumns, ComputesSpeedAndYawRateFromLeftAndRightWheels) {
  EXPECT_THAT(guesses_of("t_s,vl,vr\n0,1,2\n", TrialKind::kLog, 0.26),
              ElementsAre("sure t_s=t_s", "unsure speed_mps=(vl+vr)/2",
                          "unsure yaw_rate_radps=(vr-vl)/0.26"));
  EXPECT_THAT(
      guesses_of("t_s,left_wheel_speed_kmh,right_wheel_speed_kmh\n0,1,2\n", TrialKind::kLog, 0.5),
      ElementsAre("sure t_s=t_s",
                  "likely speed_mps=(left_wheel_speed_kmh+right_wheel_speed_kmh)/"
                  "2*0.2777778",
                  "likely yaw_rate_radps=(right_wheel_speed_kmh-left_wheel_speed_kmh)/"
                  "0.5*0.2777778"));
  EXPECT_THAT(
      guesses_of("t_s,speed_mps,gyro_radps,vl,vr\n0,1,2,1,2\n", TrialKind::kLog, 0.26),
      ElementsAre("sure t_s=t_s", "sure speed_mps=speed_mps", "likely yaw_rate_radps=gyro_radps"))
      << "columns of their own come first";
  EXPECT_THAT(guesses_of("t_s,vl,vr\n0,1,2\n"),
              ElementsAre("sure t_s=t_s", "unsure speed_mps=(vl+vr)/2", "unsure yaw_rate_radps="))
      << "without a track there is only the formula, in the reason";
  EXPECT_THAT(guesses_of("t_s,vl_cmd,vr_cmd,wheel_rpm_left,wheel_rpm_right\n0,1,2,3,4\n",
                         TrialKind::kLog, 0.26),
              ElementsAre("sure t_s=t_s"))
      << "neither set-points nor numbers of revolutions are speeds";
}

TEST(GuessColumns, ReadsUnitsInNames) {
  EXPECT_THAT(guesses_of("time_ms,Speed (km/h),gyro_z_dps,heading_rad\n0,1,2,3\n"),
              ElementsAre("likely t_s=`time_ms`*0.001", "likely heading_deg=heading_rad*57.29578",
                          "likely speed_mps=`Speed (km/h)`*0.2777778",
                          "likely yaw_rate_radps=gyro_z_dps*0.01745329"));
}

TEST(GuessColumns, ReadsColumnsThatAreCalledByTheirUnit) {
  EXPECT_THAT(guesses_of("ms,kmh,gyro_dps,servo_deg\n0,1,2,3\n20,1,2,3\n"),
              ElementsAre("likely t_s=ms*0.001", "likely speed_mps=kmh*0.2777778",
                          "likely yaw_rate_radps=gyro_dps*0.01745329",
                          "likely steering_cmd_deg=servo_deg"));
  // No guess for "ms": the values do not grow from row to row, so they may be metres per second.
  EXPECT_THAT(guesses_of("ms\n1\n1.2\n0.9\n"), IsEmpty());
}

TEST(GuessColumns, ReadsTheTablesAsWell) {
  EXPECT_THAT(guesses_of("pwm,dist_cm,ms\n200,500,3100\n", TrialKind::kSurge),
              ElementsAre("unsure wheel_force=pwm/255", "likely distance_m=dist_cm*0.01",
                          "likely elapsed_s=ms*0.001"));
  EXPECT_THAT(guesses_of("angle_deg,throttle,laps,time_min\n20,0.5,3,0.5\n", TrialKind::kTurning),
              ElementsAre("likely steering_deg=angle_deg", "likely wheel_force=throttle",
                          "likely turns=laps", "likely elapsed_s=time_min*60"));
  EXPECT_THAT(guesses_of("start_speed_kmh,stop_ms\n5,900\n", TrialKind::kCoastdown),
              ElementsAre("likely initial_speed_mps=start_speed_kmh*0.2777778",
                          "likely stop_time_s=stop_ms*0.001"));
}

TEST(GuessColumns, GuessesNothingFromAnAmbiguousName) {
  EXPECT_THAT(guesses_of("v,yaw_rate,steering\n1,0.1,0.2\n"),
              ElementsAre("unsure speed_mps=v", "unsure yaw_rate_radps=yaw_rate",
                          "unsure steering_deg=steering"));
}

TEST(GuessColumns, ReadsBodyVelocitiesByTheirLetters) {
  EXPECT_THAT(guesses_of("u_mps,v_mps,r_radps,u_ref_mps\n1,0.1,0.2,1\n1.1,0.2,0.3,1\n"),
              ElementsAre("likely speed_mps=u_mps", "likely sway_mps=v_mps",
                          "likely yaw_rate_radps=r_radps"));
  EXPECT_THAT(guesses_of("v_mps\n1\n"), ElementsAre("likely speed_mps=v_mps"));
}

TEST(GuessColumns, GuessesUnitsFromTheValues) {
  EXPECT_THAT(guesses_of("heading\n170\n-20\n"), ElementsAre("likely heading_deg=heading"));
  EXPECT_THAT(guesses_of("duty_left,duty_right\n0.5,-0.2\n"),
              ElementsAre("likely force_left=duty_left", "likely force_right=duty_right"));
  EXPECT_THAT(guesses_of("pwm_left\n80\n"), ElementsAre("unsure force_left=pwm_left/100"));
  EXPECT_THAT(guesses_of("pwm_left\n200\n"), ElementsAre("unsure force_left=pwm_left/255"));
  EXPECT_THAT(guesses_of("pwm_left\n1500\n1900\n"),
              ElementsAre("unsure force_left=(pwm_left - 1500)/500"));
}

TEST(GuessColumns, AServosPulseIsNoAngle) {
  EXPECT_THAT(guesses_of("servo_us,gz_dps\n1500,-0.39\n1875,10\n"),
              ElementsAre("likely yaw_rate_radps=gz_dps*0.01745329",
                          "unsure steering_cmd_deg=(servo_us - 1500)/500*20"));
}

TEST(GuessColumns, ARisingTimeIsTakenFromItsNameAndUnit) {
  EXPECT_THAT(guesses_of("TimeUS,a\n0,1\n100000,1\n"), ElementsAre("likely t_s=TimeUS*1e-06"));
  EXPECT_THAT(guesses_of("ms_today,a\n5,1\n25,1\n"), ElementsAre("likely t_s=ms_today*0.001"));
  EXPECT_THAT(guesses_of("t,a\n0,1\n0.1,1\n"), ElementsAre("unsure t_s=t"));
  EXPECT_THAT(guesses_of("t,a\n0.1,1\n0,1\n"), IsEmpty()) << "a time rises";
}

TEST(GuessColumns, OneCommandIsTheForceOfBothSides) {
  EXPECT_THAT(
      guesses_of("throttle_pct,battery_voltage\n10,12\n20,12\n"),
      ElementsAre("unsure force_left=throttle_pct*0.01", "unsure force_right=throttle_pct*0.01"));
  EXPECT_THAT(guesses_of("duty_left,duty_right,throttle\n0.1,0.2,1\n"),
              ElementsAre("likely force_left=duty_left", "likely force_right=duty_right"));
}

TEST(GuessColumns, AGyroscopeIsNoHeadingAndAPulseIsACommand) {
  EXPECT_THAT(guesses_of("gyroYaw,SteeringPWM\n1,1500\n-2,1700\n"),
              ElementsAre("unsure yaw_rate_radps=gyroYaw",
                          "unsure steering_cmd_deg=(SteeringPWM - 1500)/500*20"));
}

TEST(GuessColumns, TwoThatFitAreBothUnsure) {
  EXPECT_THAT(
      guesses_of("speed_kmh,gps_speed_mps\n1,2\n"),
      ElementsAre("unsure speed_mps=speed_kmh*0.2777778", "unsure speed_mps=gps_speed_mps"));
}

TEST(GuessColumns, TakesTheHeadingFromAQuaternion) {
  const auto guesses = guesses_of(
      "odom.pose.pose.orientation.x,odom.pose.pose.orientation.y,odom.pose.pose.orientation.z,"
      "odom.pose.pose.orientation.w,odom.twist.twist.linear.x,odom.twist.twist.angular.z\n"
      "0,0,0,1,2,3\n");
  ASSERT_EQ(guesses.size(), 3U);
  EXPECT_THAT(guesses[0], HasSubstr("likely heading_deg=atan2("));
  EXPECT_EQ(guesses[1], "likely speed_mps=odom.twist.twist.linear.x");
  EXPECT_EQ(guesses[2], "likely yaw_rate_radps=odom.twist.twist.angular.z");
}

TEST(GuessColumns, GuessesNothingWithoutColumns) {
  EXPECT_THAT(guesses_of("a,b,accel_x,voltage\n1,2,3,4\n"), IsEmpty());
}

TEST(GuessColumns, TwoTimesAreAmbiguous) {
  EXPECT_THAT(guesses_of("time_ms,gps_timestamp_us\n1,2\n"), ElementsAre("unsure t_s="));
}

TEST(GuessColumns, ColumnsThatNoGuessUsesAreListed) {
  FileSample sample;
  sample.names = {"time_ms", "duty_left", "v (km/h)", "battery", "count no. 2", "gz_dps"};
  sample.values.assign(sample.names.size(), {1.0, 2.0});
  sample.texts.assign(sample.names.size(), "1");
  EXPECT_THAT(unused_columns(sample, guess_columns(sample, TrialKind::kLog)),
              ElementsAre("battery", "count no. 2"));
  const std::vector<ColumnGuess> one{
      {.column = "speed_mps", .expression = "v (km/h)*0.2777778+1", .why = ""}};
  EXPECT_THAT(unused_columns(sample, one),
              ElementsAre("time_ms", "duty_left", "battery", "count no. 2", "gz_dps"));
}

}  // namespace
}  // namespace awmr::testing::column_guess_test
