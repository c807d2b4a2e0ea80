/// Driving logs: accepted and refused data, measured rows, and steady runs in logs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "awmr/core/random.h"
#include "awmr/core/units.h"
#include "awmr/trials/replay.h"
#include "awmr/trials/steady.h"
#include "steady_log.h"
#include "trial_text.h"

namespace awmr::testing::log_test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// Twelve rows at 10 Hz with these additional columns, each a function of the row.
template <class Cell>
std::string log_text(const std::string& columns, Cell cell, int rows = 12) {
  std::string text = "t_s,force_left,force_right,steering_cmd_deg," + columns + "\n";
  for (int i = 0; i < rows; ++i) {
    text += std::to_string(0.1 * i) + ",0.2,0.2,5," + cell(i) + "\n";
  }
  return text;
}

Read<DrivingLog> accepted_log(const std::string& text) { return accepted(read_log, text); }

TEST(Log, ReadsChannelsInSi) {
  const auto read = accepted_log(log_text("heading_deg,yaw_rate_radps", [](int i) {
    return std::to_string(10 * i) + "," + std::to_string(0.1 * i);
  }));
  const DrivingLog& log = read.set;
  EXPECT_EQ(log.rows(), 12U);
  EXPECT_EQ(log.line[0], 2);
  EXPECT_NEAR(log[LogChannel::kHeading]->value[3], radians(30.0), 1e-12);
  EXPECT_NEAR((*log.steering_command_rad)[0], radians(5.0), 1e-12);
  EXPECT_FALSE(log[LogChannel::kSpeed]);
  EXPECT_NEAR(log.median_step_s(), 0.1, 1e-9);
}

/// Reads a log with twelve rows at 10 Hz, forces of 0.2 and these speeds.
Read<DrivingLog> log_with_speeds(const std::function<double(int)>& speed_mps) {
  return accepted_log(log_text("speed_mps", [&](int i) { return std::to_string(speed_mps(i)); }));
}

TEST(Log, FromRestWithMotorsOnHasARowWithoutForcesBefore) {
  const DrivingLog log = log_with_speeds([](int i) { return i < 6 ? 0.001 * i : 0.2 * i; }).set;
  ASSERT_EQ(log.rows(), 13U);
  EXPECT_NEAR(log.t_s[0], -0.1, 1e-9);
  EXPECT_EQ(log.force_left[0], 0.0);
  EXPECT_EQ(log.force_right[0], 0.0);
  EXPECT_EQ(log.force_left[1], 0.2);
  EXPECT_EQ((*log.steering_command_rad)[0], (*log.steering_command_rad)[1]);
  EXPECT_FALSE(is_measurement(log, LogChannel::kSpeed, 0));
  EXPECT_TRUE(is_measurement(log, LogChannel::kSpeed, 1));
  EXPECT_EQ(log.line[1], 2);
}

TEST(Log, InMotionHasNoRowBefore) {
  const DrivingLog log = log_with_speeds([](int i) { return 1.0 + 0.1 * i; }).set;
  EXPECT_EQ(log.rows(), 12U);
  EXPECT_EQ(log.force_left[0], 0.2);
}

TEST(Log, FastStartFromRestIsNoMotion) {
  // Within five rows, the speed reaches 40 % and its median 20 % of the largest speed.
  EXPECT_EQ(log_with_speeds([](int i) { return std::min(0.1 * i, 1.0); }).set.rows(), 13U);
  // A difference of positions is 0 in the first row, but the vehicle moves.
  EXPECT_EQ(log_with_speeds([](int i) { return i == 0 ? 0.0 : 1.0 + 0.01 * i; }).set.rows(), 12U);
}

std::vector<std::string> constant_columns(const Read<DrivingLog>& read) {
  std::vector<std::string> columns;
  for (const Finding& finding : read.findings) {
    if (finding.code != "constant-channel") continue;
    columns.push_back(finding.message.substr(0, finding.message.find(' ')));
  }
  return columns;
}

TEST(Log, AChannelThatIsConstantWhileOthersMoveIsSetAside) {
  const auto moving = [](const std::string& constant) {
    return [constant](int i) { return std::to_string(0.1 * i) + "," + constant; };
  };
  for (const char* constant : {"0", "0.0", "-0.25"}) {
    const auto read = accepted_log(log_text("speed_mps,sway_mps", moving(constant)));
    EXPECT_THAT(constant_columns(read), ElementsAre("sway_mps")) << constant;
    EXPECT_FALSE(read.set[LogChannel::kSway]);
    EXPECT_TRUE(read.set[LogChannel::kSpeed]);
  }
  const auto straight =
      accepted_log(log_text("speed_mps,yaw_rate_radps,heading_deg", moving("0,90")));
  EXPECT_THAT(constant_columns(straight), ElementsAre("heading_deg", "yaw_rate_radps"));
  EXPECT_FALSE(straight.set[LogChannel::kHeading] || straight.set[LogChannel::kYawRate]);
  const auto turning = accepted_log(log_text("yaw_rate_radps,speed_mps", moving("0.5")));
  EXPECT_THAT(constant_columns(turning), ElementsAre("speed_mps"));
}

TEST(Log, AtRestOrWithItsOwnChangesAChannelIsKept) {
  const auto at_rest = accepted_log(log_text(
      "speed_mps,yaw_rate_radps", [](int i) { return "0," + std::to_string(0.001 * (i % 3)); }));
  EXPECT_THAT(constant_columns(at_rest), ::testing::IsEmpty());
  EXPECT_TRUE(at_rest.set[LogChannel::kSpeed]);
  const auto swaying = accepted_log(log_text("speed_mps,sway_mps", [](int i) {
    return std::to_string(0.1 * i) + (i == 5 ? ",1e-9" : ",0");
  }));
  EXPECT_THAT(constant_columns(swaying), ::testing::IsEmpty());
}

TEST(Log, UnwrapsTheHeadingEitherWay) {
  const auto up = accepted_log(log_text("heading_deg", [](int i) {
    return std::to_string(std::remainder(150.0 + 20.0 * i, 360.0));
  }));
  const auto down = accepted_log(log_text("heading_deg", [](int i) {
    return std::to_string(std::remainder(-150.0 - 20.0 * i, 360.0));
  }));
  for (std::size_t i = 0; i < 12; ++i) {
    const double turned = radians(20.0 * static_cast<double>(i));
    EXPECT_NEAR(up.set[LogChannel::kHeading]->value[i], radians(150.0) + turned, 1e-6);
    EXPECT_NEAR(down.set[LogChannel::kHeading]->value[i], radians(-150.0) - turned, 1e-6);
  }
}

TEST(Log, CountsOnlyNewValuesOfASlowSensor) {
  // The position changes in every third row; y sometimes stays the same by chance.
  const auto read = accepted_log(log_text(
      "x_m,y_m,speed_mps",
      [](int i) {
        return std::to_string(i / 3) + "," + std::to_string(i / 6) + "," +
               std::to_string(1.0 + 0.01 * i);
      },
      30));
  EXPECT_THAT(codes_of(read.findings), ElementsAre("held-samples@0", "held-samples@0"));
  EXPECT_EQ(read.set[LogChannel::kX]->fresh_count, 10);
  EXPECT_EQ(read.set[LogChannel::kY]->fresh_count, 10);
  EXPECT_TRUE(read.set[LogChannel::kX]->fresh[3]);
  EXPECT_FALSE(read.set[LogChannel::kX]->fresh[4]);
  EXPECT_EQ(read.set[LogChannel::kSpeed]->fresh_count, 30);
}

TEST(Log, TakesASignalAtRestAsMeasured) {
  const auto read = accepted_log(log_text("speed_mps", [](int) { return std::string("0"); }));
  EXPECT_FALSE(read.set[LogChannel::kSpeed]->held);
  EXPECT_EQ(read.set[LogChannel::kSpeed]->fresh_count, 12);
}

TEST(Log, TurnsLatitudeAndLongitudeIntoMetres) {
  // On the WGS-84 ellipsoid at the equator a degree of longitude is 111319.49 m, one of latitude
  // 110574.3 m. Over 1e-4 of a degree the Earth's curvature is below a micrometre.
  const auto read = accepted_log(log_text("latitude_deg,longitude_deg", [](int i) {
    return "0.000" + std::to_string(i % 10) + ",0.00" + std::to_string(10 + i);
  }));
  EXPECT_NEAR(read.set[LogChannel::kX]->value[5], 5 * 1e-4 * 111319.4908, 1e-4);
  EXPECT_NEAR(read.set[LogChannel::kY]->value[5], 5 * 1e-4 * 110574.2727, 1e-3);
}

TEST(Log, RefusesUnusableLogs) {
  EXPECT_THAT(faults_of(read_log, "t_s,force_left,force_right\n0,0,0\n"), SizeIs(3));
  EXPECT_THAT(
      faults_of(read_log,
                log_text("speed_mps", [](int i) { return std::string(i == 5 ? "nan" : "1"); })),
      ElementsAre(StartsWith("7:")));
  std::string text = log_text("speed_mps", [](int) { return std::string("1"); });
  text += "0.5,0.2,0.2,5,1\n";
  EXPECT_THAT(faults_of(read_log, text), ElementsAre(HasSubstr("time must increase")));
  EXPECT_THAT(faults_of(read_log, log_text(
                                      "speed_mps", [](int) { return std::string("1"); }, 5)),
              ElementsAre(HasSubstr("at least 10")));
  EXPECT_THAT(faults_of(read_log, log_text("latitude_deg", [](int) { return std::string("1"); })),
              ElementsAre(HasSubstr("belong together")));
}

/// A drive at 1 m/s with the heading 90 deg, and two rests: at its beginning and in its middle.
/// `course`: heading in the rows at rest. `after_deg`: heading after the second rest. `noise_deg`:
/// standard deviation of the noise of all headings.
std::string with_rests(const std::function<double(int)>& course, double after_deg = 90.0,
                       double noise_deg = 0.0) {
  Random random(1, 2);
  const auto cell = [&](int i) {
    const bool rests = i < 10 || (i >= 30 && i < 40);
    const double heading = rests ? course(i) : i < 30 ? 90.0 : after_deg;
    return std::to_string(rests ? 0.0 : 1.0 + 0.01 * (i % 3)) + "," +
           std::to_string(heading + 0.1 * (i % 2) + noise_deg * random.normal());
  };
  return log_text("speed_mps,heading_deg", cell, 60);
}

std::vector<std::string> codes(const Read<DrivingLog>& read) {
  std::vector<std::string> all;
  for (const Finding& finding : read.findings) all.push_back(finding.code);
  return all;
}

TEST(Log, EmptyCellsOfAChannelWithOnlyChangesAreUnchangedReadings) {
  constexpr int kRows = 400;
  std::string last;
  const auto cell = [&](int i) {
    char text[16];
    std::snprintf(text, sizeof text, "%.2f", 0.5 - 0.5 * std::cos(0.02 * i));
    return last == text ? std::string() : last = text;
  };
  const auto read = accepted_log(log_text("speed_mps", cell, kRows));
  EXPECT_THAT(codes(read), Contains("only-changes"));
  const Measured& speed = *read.set[LogChannel::kSpeed];
  EXPECT_GT(speed.fresh_count, kRows - 30);
  EXPECT_NEAR(speed.quantum, 0.01, 1e-9);
}

TEST(Log, ACourseAtRestIsSetAside) {
  for (const auto& course : {std::function<double(int)>([](int) { return 0.0; }),
                             std::function<double(int)>([](int i) { return 77.0 * i; })}) {
    const auto read = accepted_log(with_rests(course));
    EXPECT_THAT(codes(read), Contains("course-at-rest"));
    const Measured& heading = *read.set[LogChannel::kHeading];
    // Row 0 is the added row of rest.
    EXPECT_FALSE(heading.fresh[6] || heading.fresh[36]);
    EXPECT_TRUE(heading.fresh[21]);
    EXPECT_NEAR(heading.value[56], radians(90.1), 1e-9);  // jumps at rest add no whole turns
  }
}

TEST(Log, ACompassAtRestIsKept) {
  const auto compass = [](int) { return 90.0; };
  EXPECT_THAT(codes(accepted_log(with_rests(compass))), Not(Contains("course-at-rest")));
  // a noisy compass, at rest and in motion
  EXPECT_THAT(codes(accepted_log(with_rests(compass, 90.0, 10.0))),
              Not(Contains("course-at-rest")));
  // the vehicle turns on the spot before it drives
  const auto spun = [](int i) { return i < 10 ? 9.0 * i : 90.0; };
  EXPECT_THAT(codes(accepted_log(with_rests(spun))), Not(Contains("course-at-rest")));
  // the vehicle is turned by hand during the second rest
  const auto turned = [](int i) { return i < 10 ? 90.0 : 90.0 + 9.0 * (i - 30); };
  EXPECT_THAT(codes(accepted_log(with_rests(turned, 180.0))), Not(Contains("course-at-rest")));
}

TEST(Log, TimesThatAreNotUsedAreLeftOut) {
  const std::string text = log_text(
      "speed_mps", [](int i) { return std::to_string(0.01 * i); }, 60);
  TrialOptions options;
  options.used_s = {1.0, 4.95};
  options.excluded_s = {{2.05, 2.95}};
  const auto logs = accepted(read_logs, text, options).set;
  ASSERT_THAT(logs, SizeIs(2));  // before and after the excluded time
  EXPECT_NEAR(logs[0].t_s.front(), 1.0, 1e-12);
  EXPECT_NEAR(logs[0].t_s.back(), 2.0, 1e-12);
  EXPECT_NEAR(logs[1].t_s.front(), 3.0, 1e-12);
  EXPECT_NEAR(logs[1].t_s.back(), 4.9, 1e-12);
  EXPECT_EQ(logs[1].line.front(), 32);  // row 30 behind the header
  EXPECT_NEAR(logs[1][LogChannel::kSpeed]->value.front(), 0.30, 1e-12);
  options.used_s = {5.5, 9.0};
  EXPECT_THAT(faults_of(read_logs, text, options), SizeIs(1));  // 5 rows
  options.used_s = {100.0, 200.0};
  EXPECT_THAT(faults_of(read_logs, text, options), ElementsAre(HasSubstr("0 to 5.9 s")));
}

TEST(Log, CutsWindowsAtGapsAndIntoEqualParts) {
  std::string text = "t_s,force_left,force_right,steering_deg,speed_mps\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(0.1 * i) + ",0.1,0.1,0,1\n";
  for (int i = 0; i < 50; ++i) text += std::to_string(30.0 + 0.1 * i) + ",0.1,0.1,0,1\n";
  const auto read = accepted_log(text);
  EXPECT_THAT(codes_of(read.findings), ElementsAre("log-gap@102"));
  const auto windows = windows_of(read.set, 6.0);
  ASSERT_THAT(windows, SizeIs(3));
  EXPECT_EQ(windows[0].end, 50U);
  EXPECT_EQ(windows[1].begin, 50U);
  EXPECT_EQ(windows[1].end, 100U);
  EXPECT_EQ(windows[2].begin, 100U);
  EXPECT_EQ(windows[2].end, 150U);
}

TEST(Log, AHeldSignalsDelayedMeanHasItsDerivative) {
  const std::vector<double> t{0.0, 1.0, 2.0, 3.0};
  const std::vector<double> value{1.0, 3.0, -2.0, 5.0};
  const HeldSignal signal(t, value);
  // The delay of 0.5 shifts [1.2, 2.2] to [0.7, 1.7], where the command is 1 for 0.3 and 3 for 0.7.
  EXPECT_NEAR(delayed_mean(signal, 1.2, 1.0, 0.5), 0.3 * 1.0 + 0.7 * 3.0, 1e-12);
  // Beyond the ends the end value holds.
  EXPECT_NEAR(delayed_mean(signal, 0.0, 1.0, 2.0), 1.0, 1e-12);
  EXPECT_NEAR(delayed_mean(signal, 5.0, 1.0, 0.0), 5.0, 1e-12);
}

TEST(SteadyRuns, AreFoundWithTheirSpansAndNotWhereTheSpeedStillRises) {
  const auto read = accepted_log(steady_log_text());
  const Vehicle vehicle = paper_vehicle();
  std::vector<Finding> findings;
  const SteadyRuns runs = steady_runs(read.set, vehicle, findings);
  ASSERT_THAT(runs.surge.rows, SizeIs(1));
  EXPECT_NEAR(runs.surge.rows[0].tau_speed, 1.2, 1e-9);
  EXPECT_NEAR(runs.surge.rows[0].speed_mps, 1.0, 1e-3);
  ASSERT_THAT(runs.turning.rows, SizeIs(1));
  EXPECT_NEAR(runs.turning.rows[0].yaw_rate_radps, 0.3, 1e-3);
  EXPECT_NEAR(runs.turning.rows[0].tau_turn_m,
              2.0 * vehicle.front_axle_m * 0.2 * std::sin(radians(10.0)), 1e-12);
  EXPECT_THAT(codes_of(findings), ElementsAre("steady-segment@52", "steady-segment@92"));
  EXPECT_THAT(findings[0].message, HasSubstr("from 5.000 to 7.900 s"));
}

TEST(SteadyRunsOfALog, AreDifferentialTurnsWithoutSteering) {
  Vehicle vehicle = paper_vehicle();
  vehicle.drive = Drive::kDifferential;
  std::string text = "t_s,force_left,force_right,speed_mps,yaw_rate_radps\n";
  for (int i = 0; i < 120; ++i) {
    const bool turn = i >= 60;  // from row 60 on, the vehicle turns to the right on the spot
    const double wiggle = i % 2 == 0 ? 1e-3 : -1e-3;
    text += std::to_string(0.1 * i) + (turn ? ",0.2,-0.2," : ",0.3,0.3,") +
            std::to_string((turn ? 0.0 : 1.0) + wiggle) + "," +
            std::to_string((turn ? -0.4 : 0.0) + wiggle) + "\n";
  }
  TrialOptions options;
  options.has_steering = false;
  const auto read = accepted(read_log, text, options);
  std::vector<Finding> findings;
  const SteadyRuns runs = steady_runs(read.set, vehicle, findings);
  ASSERT_THAT(runs.surge.rows, SizeIs(1));
  EXPECT_NEAR(runs.surge.rows[0].tau_speed, 1.2, 1e-9);
  ASSERT_THAT(runs.turning.rows, SizeIs(1));
  EXPECT_NEAR(runs.turning.rows[0].yaw_rate_radps, 0.4, 1e-3);
  // tau_turn = 2 d (F'R - F'L)                                                      [paper (41)]
  EXPECT_NEAR(runs.turning.rows[0].tau_turn_m, 2.0 * vehicle.half_track_m * 0.4, 1e-12);
  EXPECT_THAT(findings.back().message, HasSubstr("force_left 0.2, force_right -0.2"));
}

TEST(SteadyWheelsOfALog, AreTheSidesOfATurnAndTheVehicleIfItDrivesStraight) {
  Vehicle vehicle = paper_vehicle();
  vehicle.drive = Drive::kDifferential;
  std::string text = "t_s,force_left,force_right,speed_mps,yaw_rate_radps\n";
  for (int i = 0; i < 120; ++i) {
    const double wiggle = i % 2 == 0 ? 1e-3 : -1e-3;
    text += std::to_string(0.1 * i) + (i >= 60 ? ",0.2,0.4," : ",0.3,0.3,") +
            std::to_string(1.5 + wiggle) + "," + std::to_string((i >= 60 ? 0.8 : 0.0) + wiggle) +
            "\n";
  }
  TrialOptions options;
  options.has_steering = false;
  const auto wheels = steady_wheels(accepted(read_log, text, options).set, vehicle, {});
  ASSERT_THAT(wheels, SizeIs(3));
  const double turn_mps = 0.8 * vehicle.half_track_m;
  const std::array expected{SteadyWheel{0.3, 1.5}, SteadyWheel{0.2, 1.5 - turn_mps},
                            SteadyWheel{0.4, 1.5 + turn_mps}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(wheels[i].command, expected[i].command, 1e-12);
    EXPECT_NEAR(wheels[i].speed_mps, expected[i].speed_mps, 1e-3);
    EXPECT_LT(wheels[i].std_error, 1e-3);
  }
}

/// A log at 50 Hz of a vehicle that drives straight at `speed_mps` with the heading psi; its
/// position is the only measurement, with an error of +-e in turn.
DrivingLog straight_log(double speed_mps, double psi, double error_m) {
  constexpr std::size_t kRows = 100;
  constexpr double kStep_s = 0.02;
  DrivingLog log;
  Measured x;
  Measured y;
  for (std::size_t row = 0; row < kRows; ++row) {
    const double t_s = kStep_s * static_cast<double>(row);
    log.t_s.push_back(t_s);
    const double e = row % 2 == 0 ? error_m : -error_m;
    x.value.push_back(1.0 + speed_mps * t_s * std::cos(psi) + e);
    y.value.push_back(2.0 + speed_mps * t_s * std::sin(psi) - e);
  }
  x.fresh = y.fresh = std::vector<bool>(kRows, true);
  log[LogChannel::kX] = x;
  log[LogChannel::kY] = y;
  log.force_left = log.force_right = std::vector<double>(kRows, speed_mps < 0.0 ? -0.3 : 0.3);
  log.steering_command_rad = std::vector<double>(kRows, 0.0);
  return log;
}

TEST(InitialState, OfPositionsHasTheHeadingAndTheSignedSpeed) {
  constexpr double kPsi = 0.5;
  for (const double speed_mps : {0.8, -0.8}) {
    const DrivingLog log = straight_log(speed_mps, kPsi, 0.02);
    const State<double> state = measured_initial_state({&log, 0, log.rows()});
    EXPECT_NEAR(state.u_mps, speed_mps, 0.03) << speed_mps;
    EXPECT_NEAR(state.psi_rad, kPsi, 0.05) << speed_mps;
  }
}

TEST(InitialState, OfPositionsAndHeadingHasTheSpeedAlongTheHeading) {
  constexpr double kPsi = 0.5;
  DrivingLog log = straight_log(-0.8, kPsi, 0.0);
  log[LogChannel::kHeading] = Measured{.value = std::vector<double>(log.rows(), kPsi),
                                       .fresh = std::vector<bool>(log.rows(), true)};
  for (auto* const forces : {&log.force_left, &log.force_right}) {
    forces->assign(log.rows(), 0.3);  // the forces brake while the vehicle still drives backward
  }
  const State<double> state = measured_initial_state({&log, 0, log.rows()});
  EXPECT_NEAR(state.u_mps, -0.8, 1e-9);
  EXPECT_EQ(state.psi_rad, kPsi);
}

}  // namespace
}  // namespace awmr::testing::log_test
