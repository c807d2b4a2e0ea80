/// Wrong units, wrong signs and swapped sides are detected before any fit, and correct logs give no
/// finding. The logs are first-order responses with noise, independent of the fitted model.
#include "awmr/trials/checks/log_consistency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "awmr/core/random.h"
#include "awmr/core/units.h"
#include "awmr/trials/calibration_checks.h"
#include "support/paper_vehicle.h"

namespace awmr::log_consistency_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kStep_s = 0.02;
constexpr std::size_t kRows = 2000;

/// Properties of a log; the defaults give a correct one.
struct Making {
  bool position = true;
  bool heading = true;
  bool yaw_rate = true;
  bool sides_apart = true;
  double noise = 1.0;
  double gyro_bias_radps = 0.0;
  bool combined = false;  ///< the wheel forces produce the same moment as the steering
};

Measured measured(std::vector<double> values) {
  const auto rows = values.size();
  return {std::move(values), std::vector<bool>(rows, true), static_cast<int>(rows), false, 0.0};
}

/// Simulated log in which the speed follows the thrust in 0.3 s, and the yaw rate follows steering
/// and left/right forces in 0.15 s.
DrivingLog sound_log(std::uint64_t seed, const Making& making = {}, std::size_t rows = kRows) {
  Random random(seed, 11);
  DrivingLog log;
  log.file = "log.csv";
  log.steering_command_rad.emplace();
  std::array<std::vector<double>, kChannelCount> values;
  const auto& push = [&values](LogChannel c, double v) {
    values[static_cast<std::size_t>(c)].push_back(v);
  };
  double level = 0.3, apart = 0.0, angle = 0.0, u = 0.0, r = 0.0, psi = 0.0, x = 0.0, y = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    if (i % 70 == 0) {
      level = 0.15 + 0.4 * random.uniform();
      apart = making.sides_apart ? 0.1 * (random.uniform() - 0.5) : 0.0;
      angle = radians(30.0) * (random.uniform() - 0.5);
      if (making.combined) {
        const Vehicle v = testing::paper_vehicle();
        apart = 0.5 * v.front_axle_m * level * std::sin(angle) / v.half_track_m;
      }
    }
    log.t_s.push_back(kStep_s * static_cast<double>(i));
    log.line.push_back(static_cast<int>(i) + 2);
    log.force_left.push_back(level - apart);
    log.force_right.push_back(level + apart);
    log.steering_command_rad->push_back(angle);
    const double n = making.noise;
    push(LogChannel::kX, x + n * 0.02 * random.normal());
    push(LogChannel::kY, y + n * 0.02 * random.normal());
    push(LogChannel::kHeading, psi + n * 0.01 * random.normal());
    push(LogChannel::kSpeed, u + n * 0.03 * random.normal());
    push(LogChannel::kYawRate, r + n * 0.02 * random.normal() + making.gyro_bias_radps);
    u += kStep_s / 0.3 * (3.0 * level - u);
    r += kStep_s / 0.15 * (u * std::tan(angle) / 0.5 + 3.0 * apart - r);
    psi += kStep_s * r;
    x += kStep_s * u * std::cos(psi);
    y += kStep_s * u * std::sin(psi);
  }
  const auto keep = [&](LogChannel c) {
    log[c] = measured(std::move(values[static_cast<std::size_t>(c)]));
  };
  keep(LogChannel::kSpeed);
  if (making.position) keep(LogChannel::kX);
  if (making.position) keep(LogChannel::kY);
  if (making.heading) keep(LogChannel::kHeading);
  if (making.yaw_rate) keep(LogChannel::kYawRate);
  return log;
}

Vehicle vehicle() {
  Vehicle vehicle = testing::paper_vehicle();
  vehicle.sample_time_s = kStep_s;
  return vehicle;
}

void scale(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

TEST(LogConsistency, AHundredGoodLogsRaiseNoAlarm) {
  const Making kinds[] = {
      {}, {.position = false}, {.heading = false}, {.sides_apart = false}, {.noise = 3.0}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const Making& making : kinds) {
      const auto found = contradictions(sound_log(seed, making), vehicle(), {});
      EXPECT_TRUE(found.empty()) << seed << ": " << found.front().column << ": "
                                 << found.front().message;
    }
  }
}

/// The same drive with its second half commanded and driven backwards.
DrivingLog reversing_log(std::uint64_t seed, bool is_signed) {
  DrivingLog log = sound_log(seed);
  std::vector<double>& speed = log[LogChannel::kSpeed]->value;
  for (std::size_t i = kRows / 2; i < kRows; ++i) {
    const double mean = 0.5 * (log.force_left[i] + log.force_right[i]);
    log.force_left[i] -= 2.0 * mean;
    log.force_right[i] -= 2.0 * mean;
    if (is_signed) speed[i] = -speed[i];
  }
  return log;
}

TEST(LogConsistency, ASpeedWithoutASignIsNamedAndOneWithASignIsNot) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto is_named = [&](const DrivingLog& log) {
      return std::ranges::any_of(contradictions(log, vehicle(), {}), [](const Contradiction& c) {
        return c.column == "speed_mps" &&
               c.message.find("does not measure the direction") < c.message.size();
      });
    };
    EXPECT_TRUE(is_named(reversing_log(seed, false))) << seed;
    EXPECT_FALSE(is_named(reversing_log(seed, true))) << seed;
  }
}

TEST(LogConsistency, RefusesAVehicleThatNeverMoves) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    DrivingLog log = sound_log(seed);
    Random random(seed, 12);
    for (const LogChannel channel : kChannels) {
      if (!log[channel]) continue;
      for (double& value : log[channel]->value) value = 0.02 * random.normal();
    }
    const auto found = contradictions(log, vehicle(), {});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found.front().column, "speed_mps");
    EXPECT_THAT(found.front().message, HasSubstr("never moves"));
  }
}

/// Number of calibration findings with this code whose message contains `words`.
int calibrations(const DrivingLog& log, const std::string& code, const std::string& words = "") {
  return static_cast<int>(
      std::ranges::count_if(calibration_findings(log, {}), [&](const Finding& finding) {
        return finding.code == code && finding.message.find(words) != std::string::npos;
      }));
}

TEST(LogConsistency, ScalesAndDirectionsOfSoundLogsAgree) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const Making& making : {Making{}, Making{.gyro_bias_radps = 0.05}, Making{.noise = 3.0}}) {
      DrivingLog log = sound_log(seed, making);
      EXPECT_TRUE(calibration_findings(log, {}).empty()) << seed;
      log[LogChannel::kHeading].reset();
      EXPECT_TRUE(calibration_findings(log, {}).empty()) << seed;
    }
  }
}

/// Keeps one reading in `every` of each channel except the yaw rate, and repeats it until the next
/// one. The readings are 0.1 s late.
DrivingLog with_slow_late_sensors(DrivingLog log, std::size_t every, bool held) {
  constexpr std::size_t kLate = 5;
  for (const LogChannel channel :
       {LogChannel::kX, LogChannel::kY, LogChannel::kHeading, LogChannel::kSpeed}) {
    Measured& one = *log[channel];
    const std::vector<double> value = one.value;
    one.held = held;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::size_t row = i - i % every;
      one.value[i] = value[row - std::min(row, kLate)];
      one.fresh[i] = row == i;
    }
  }
  return log;
}

TEST(LogConsistency, SlowLateSensorsAgreeWithAFastGyroscope) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const DrivingLog log = sound_log(seed, {}, 5 * kRows);
    for (const std::size_t every : {5U, 10U, 25U}) {
      for (const bool held : {false, true}) {
        const DrivingLog late = with_slow_late_sensors(log, every, held);
        EXPECT_FALSE(gyro_bias_radps(late)) << seed << " " << every;
        EXPECT_EQ(calibrations(late, "scale-mismatch"), 0) << seed << " " << every;
        EXPECT_FALSE(heading_offset_rad(late)) << seed << " " << every;
      }
    }
  }
}

TEST(LogConsistency, AMisalignedCompassAndScalesThatAreOffAreNamed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    DrivingLog turned = sound_log(seed);
    for (double& psi : turned[LogChannel::kHeading]->value) psi += radians(6.0);
    EXPECT_EQ(calibrations(turned, "heading-offset"), 1) << seed;
    EXPECT_EQ(calibrations(turned, "scale-mismatch"), 0) << seed;
    DrivingLog gyro = sound_log(seed);
    scale(gyro[LogChannel::kYawRate]->value, 1.1);
    EXPECT_EQ(calibrations(gyro, "scale-mismatch", "gyroscope is wrong; map"), 1) << seed;
    DrivingLog wheel = sound_log(seed);
    scale(wheel[LogChannel::kSpeed]->value, 0.9);
    EXPECT_EQ(calibrations(wheel, "scale-mismatch", "or that of the positions"), 1) << seed;
    wheel[LogChannel::kHeading].reset();
    EXPECT_EQ(calibrations(wheel, "scale-mismatch", "or that of the positions"), 1) << seed;
    DrivingLog alone = sound_log(seed, {.position = false});
    scale(alone[LogChannel::kYawRate]->value, 1.1);
    EXPECT_EQ(calibrations(alone, "scale-mismatch", "one of them has a wrong scale"), 1) << seed;
  }
}

TEST(LogConsistency, OdometryWithAWrongTrackWidthIsNamedByThePositions) {
  int with_heading = 0;
  int with_rate = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    DrivingLog odometry = sound_log(seed);
    scale(odometry[LogChannel::kYawRate]->value, 0.92);
    scale(odometry[LogChannel::kHeading]->value, 0.92);
    with_heading += calibrations(odometry, "scale-mismatch", "according to the positions");
    odometry[LogChannel::kHeading].reset();
    with_rate += calibrations(odometry, "scale-mismatch", "according to the positions");
  }
  // In one of the 20 drives, the vehicle turns too little for a deviation of five standard errors.
  EXPECT_GE(with_heading, 19);
  EXPECT_GE(with_rate, 19);
}

/// The first ten seconds of a drive.
constexpr std::size_t kFirstRows = 500;

TEST(LogConsistency, TheFirstTenSecondsOfAHundredGoodLogsRaiseNoAlarm) {
  const Making kinds[] = {
      {}, {.position = false}, {.heading = false}, {.sides_apart = false}, {.noise = 3.0}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const Making& making : kinds) {
      const auto found = contradictions(sound_log(seed, making, kFirstRows), vehicle(), {});
      EXPECT_TRUE(found.empty()) << seed << ": " << found.front().column << ": "
                                 << found.front().message;
    }
  }
}

/// Keeps every n-th value, and repeats it until the next one.
void hold(LogChannel channel, std::size_t n, DrivingLog& log) {
  Measured& held = *log[channel];
  held.held = true;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    held.fresh[row] = row % n == 0;
    held.value[row] = held.value[row - row % n];
  }
}

TEST(LogConsistency, SensorsSlowerThanTheLogHaveNoOtherUnit) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const std::size_t n : {5, 10, 25, 40, 50}) {
      DrivingLog log = sound_log(seed);
      for (const LogChannel c : {LogChannel::kX, LogChannel::kY, LogChannel::kHeading}) {
        hold(c, n, log);
      }
      const auto found = contradictions(log, vehicle(), {});
      EXPECT_TRUE(found.empty()) << seed << ", one in " << n << ": " << found.front().column << ": "
                                 << found.front().message;
      scale(log[LogChannel::kSpeed]->value, 3.6);
      EXPECT_FALSE(contradictions(log, vehicle(), {}).empty()) << seed << ", one in " << n;
    }
  }
}

/// Keeps every n-th row.
DrivingLog thinned(const DrivingLog& log, std::size_t n) {
  DrivingLog thin = log;
  const auto thin_out = [n](auto& values) {
    std::size_t kept = 0;
    for (std::size_t row = 0; row < values.size(); row += n) values[kept++] = values[row];
    values.resize(kept);
  };
  thin_out(thin.t_s);
  thin_out(thin.line);
  thin_out(thin.force_left);
  thin_out(thin.force_right);
  thin_out(*thin.steering_command_rad);
  for (auto& channel : thin.measured) {
    if (!channel) continue;
    thin_out(channel->value);
    thin_out(channel->fresh);
  }
  return thin;
}

TEST(LogConsistency, ALogWithOneRowPerSecondIsReadWithoutChecks) {
  for (const std::size_t n : {20, 27, 50, 100, 500}) {
    Vehicle slow = vehicle();
    slow.sample_time_s = kStep_s * static_cast<double>(n);
    EXPECT_TRUE(contradictions(thinned(sound_log(1), n), slow, {}).empty()) << n;
  }
}

TEST(LogConsistency, ATimeInMinutesHoursOrDaysIsNamed) {
  for (const double factor : {60.0, 1e3, 3600.0, 86400.0}) {
    DrivingLog log = sound_log(1);
    scale(log.t_s, 1.0 / factor);
    const auto found = contradictions(log, vehicle(), {});
    EXPECT_TRUE(std::ranges::any_of(found, [](const auto& c) { return c.column == "t_s"; }))
        << factor;
  }
}

TEST(LogConsistency, InTheCombinedModeAReversedSteeringAndSwappedSidesAreNamed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const DrivingLog sound = sound_log(seed, {.combined = true});
    EXPECT_TRUE(contradictions(sound, vehicle(), {}).empty()) << seed;
    DrivingLog reversed = sound;
    scale(*reversed.steering_command_rad, -1.0);
    DrivingLog swapped = sound;
    std::swap(swapped.force_left, swapped.force_right);
    for (const auto& [log, column] :
         {std::pair(&reversed, "steering_cmd_deg"), std::pair(&swapped, "force_left")}) {
      const auto found = contradictions(*log, vehicle(), {});
      ASSERT_EQ(found.size(), 1U) << seed << ", " << column;
      EXPECT_EQ(found.front().column, column) << seed;
    }
  }
}

struct WrongTurn {
  std::string name;
  std::function<void(DrivingLog&)> make;
  std::string column;
  std::string words;
  /// Minimum number of drives, out of ten, whose first ten seconds reveal the fault. A wrong unit
  /// is visible at once, a wrong sign only after the motion that depends on it.
  int early = 9;
};

std::ostream& operator<<(std::ostream& out, const WrongTurn& turn) { return out << turn.name; }

class AWrongTurn : public ::testing::TestWithParam<WrongTurn> {};

TEST_P(AWrongTurn, IsNamedInEveryLog) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrivingLog log = sound_log(seed);
    GetParam().make(log);
    const auto found = contradictions(log, vehicle(), {});
    ASSERT_FALSE(found.empty()) << seed;
    EXPECT_EQ(found.front().column, GetParam().column) << seed << found.front().message;
    EXPECT_THAT(found.front().message + found.front().mapping, HasSubstr(GetParam().words));
  }
}

/// Replaces speed and yaw rate by those of wheel odometry with the left side reversed: the speed is
/// then d r, the yaw rate u/d.
void reverse_left_wheels(DrivingLog& log) {
  const double d = vehicle().half_track_m;
  std::vector<double>& speed = log[LogChannel::kSpeed]->value;
  std::vector<double>& rate = log[LogChannel::kYawRate]->value;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double u = speed[i];
    speed[i] = d * rate[i];
    rate[i] = u / d;
  }
}

TEST(LogConsistency, BlamesReversedWheelOdometryInsteadOfTheForces) {
  DrivingLog log = sound_log(1, {.position = false});
  std::ranges::fill(*log.steering_command_rad, 0.0);
  const auto moved = [&log](double turn) {  // only force differences turn it
    for (std::size_t i = 0; i < log.rows(); ++i) {
      log[LogChannel::kYawRate]->value[i] =
          turn * (log.force_right[i] - log.force_left[i]) + 1e-4 * static_cast<double>(i % 7);
    }
  };
  moved(3.0);
  double psi = 0.0;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    log[LogChannel::kHeading]->value[i] = psi;
    psi += kStep_s * log[LogChannel::kYawRate]->value[i];
  }
  EXPECT_TRUE(contradictions(log, vehicle(), {}).empty());
  reverse_left_wheels(log);
  const auto by_heading = contradictions(log, vehicle(), {});
  ASSERT_EQ(by_heading.size(), 1U);
  EXPECT_EQ(by_heading[0].column, "speed_mps");
  EXPECT_THAT(by_heading[0].message, HasSubstr("one side is reversed"));
  EXPECT_EQ(by_heading[0].mapping, "");
  // Without the heading, a force column with the wrong sign explains the log as well.
  log[LogChannel::kHeading].reset();
  const auto alone = contradictions(log, vehicle(), {});
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(alone[0].column, "force_left");
  EXPECT_THAT(alone[0].message, HasSubstr("one side is reversed"));
  EXPECT_THAT(alone[0].remedy, HasSubstr("find out which column is wrong"));
}

TEST_P(AWrongTurn, IsNamedInTheFirstTenSeconds) {
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrivingLog log = sound_log(seed, {}, kFirstRows);
    GetParam().make(log);
    for (const Contradiction& one : contradictions(log, vehicle(), {})) {
      named += one.column == GetParam().column;
    }
  }
  EXPECT_GE(named, GetParam().early);
}

std::vector<double>& channel(DrivingLog& log, LogChannel c) { return log[c]->value; }

INSTANTIATE_TEST_SUITE_P(
    LogConsistency, AWrongTurn,
    ::testing::Values(
        WrongTurn{"KilometresPerHour",
                  [](DrivingLog& l) { scale(channel(l, LogChannel::kSpeed), 3.6); }, "speed_mps",
                  "km/h"},
        WrongTurn{
            "DegreesPerSecond",
            [](DrivingLog& l) { scale(channel(l, LogChannel::kYawRate), 180.0 / pi<double>()); },
            "yaw_rate_radps", "0.01745329"},
        WrongTurn{"Milliseconds", [](DrivingLog& l) { scale(l.t_s, 1000.0); }, "t_s", "0.001"},
        WrongTurn{"Nanoseconds", [](DrivingLog& l) { scale(l.t_s, 1e9); }, "t_s", "1e-09"},
        WrongTurn{"RightSideReversed", [](DrivingLog& l) { scale(l.force_right, -1.0); },
                  "force_right", "\"force_right\"*-1", 9},
        WrongTurn{"LeftSideReversed", [](DrivingLog& l) { scale(l.force_left, -1.0); },
                  "force_left", "\"force_left\"*-1", 9},
        WrongTurn{"AReceiverWithoutAFix",
                  [](DrivingLog& l) {
                    for (const LogChannel c : {LogChannel::kX, LogChannel::kY}) {
                      for (std::size_t i = 0; i < l.rows() / 8; ++i) {
                        channel(l, c)[i + l.rows() / 2] = 0.0;
                      }
                      for (std::size_t i = 0; i < l.rows(); ++i) {
                        if (channel(l, c)[i] != 0.0) channel(l, c)[i] += 20.0;
                      }
                    }
                  },
                  "x_m", "without a fix", 9},
        WrongTurn{"Percent",
                  [](DrivingLog& l) {
                    scale(l.force_left, 150.0);
                    scale(l.force_right, 150.0);
                  },
                  "force_left", "percent"},
        WrongTurn{"PwmOf255",
                  [](DrivingLog& l) {
                    scale(l.force_left, 255.0);
                    scale(l.force_right, 255.0);
                  },
                  "force_left", "0.003921569"},
        WrongTurn{"Microseconds",
                  [](DrivingLog& l) {
                    for (auto* force : {&l.force_left, &l.force_right}) {
                      for (double& value : *force) value = 1500.0 + 500.0 * value;
                    }
                  },
                  "force_left", "microseconds"},
        WrongTurn{"SidesSwapped", [](DrivingLog& l) { std::swap(l.force_left, l.force_right); },
                  "force_left", "force_left=\"force_right\"", 5},
        WrongTurn{"SteeringReversed", [](DrivingLog& l) { scale(*l.steering_command_rad, -1.0); },
                  "steering_cmd_deg", "*-1"},
        WrongTurn{"YawRateReversed",
                  [](DrivingLog& l) { scale(channel(l, LogChannel::kYawRate), -1.0); },
                  "yaw_rate_radps", "*-1"},
        WrongTurn{"YMirrored", [](DrivingLog& l) { scale(channel(l, LogChannel::kY), -1.0); },
                  "y_m", "mirror", 1},
        WrongTurn{"TwoRunsInOneFileByTheirPositions",
                  [](DrivingLog& l) {
                    for (std::size_t i = kRows / 8; i < l.rows(); ++i) {
                      channel(l, LogChannel::kX)[i] += 11.0;
                    }
                  },
                  "x_m", "two runs in one file"},
        WrongTurn{"TwoRunsInOneFileByTheirHeading",
                  [](DrivingLog& l) {
                    l[LogChannel::kX].reset();
                    for (std::size_t i = kRows / 8; i < l.rows(); ++i) {
                      channel(l, LogChannel::kHeading)[i] += 2.5;
                    }
                  },
                  "heading_deg", "jumps by"},
        WrongTurn{"HeadingInRadiansThatGoesOnBeyondATurn",
                  [](DrivingLog& l) {
                    for (double& psi : channel(l, LogChannel::kHeading)) psi = radians(psi) + 0.5;
                  },
                  "heading_deg", "57.29578", 8},
        WrongTurn{"SteeringInRadians",
                  [](DrivingLog& l) { scale(*l.steering_command_rad, pi<double>() / 180.0); },
                  "steering_cmd_deg", "57.29578", 5},
        WrongTurn{"ServoAnglesAboutNinety",
                  [](DrivingLog& l) {
                    for (double& angle : *l.steering_command_rad) angle += radians(90.0);
                  },
                  "steering_cmd_deg", "\"steering_cmd_deg\"-90"},
        WrongTurn{"ServoPulses",
                  [](DrivingLog& l) {
                    for (double& angle : *l.steering_command_rad) {
                      angle = radians(1500.0 + 500.0 * degrees(angle) / vehicle().steering_max_deg);
                    }
                  },
                  "steering_cmd_deg", "us"},
        WrongTurn{"RevolutionsPerMinute",
                  [](DrivingLog& l) { scale(channel(l, LogChannel::kYawRate), 9.549297); },
                  "yaw_rate_radps", "0.1047198"},
        WrongTurn{"Knots", [](DrivingLog& l) { scale(channel(l, LogChannel::kSpeed), 1.943844); },
                  "speed_mps", "0.51444", 5},
        WrongTurn{"PositionsInMillimetres",
                  [](DrivingLog& l) {
                    scale(channel(l, LogChannel::kX), 1000.0);
                    scale(channel(l, LogChannel::kY), 1000.0);
                  },
                  "x_m", "mm"}),
    [](const auto& turn) { return turn.param.name; });

// The vehicle drives at about 0.2 m/s, and fixes have a noise of 0.2 m. The measured ends of a
// window of 1 s are sqrt(0.2^2 + 4*0.2^2) = 0.45 m apart, 2.2 times the distance driven. If the
// noise were neglected, a factor above 1.6 would count as another unit.
TEST(LogConsistency, NoiseAsLargeAsTheDistanceIsNotTakenForAnotherUnit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    DrivingLog log = sound_log(seed);
    Random random(seed, 12);
    scale(channel(log, LogChannel::kSpeed), 0.2);
    for (const LogChannel c : {LogChannel::kX, LogChannel::kY}) {
      for (double& value : channel(log, c)) value = 0.2 * value + 0.2 * random.normal();
    }
    for (const Contradiction& one : contradictions(log, vehicle(), {})) {
      EXPECT_THAT(one.message, Not(HasSubstr("times the integral of the speed"))) << seed;
    }
  }
}

TEST(LogConsistency, AFixThatComesBackAndOneAfterADropoutAreNoOtherRun) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrivingLog log = sound_log(seed);
    channel(log, LogChannel::kX)[700] += 40.0;
    // For two seconds the log has no fix, while the vehicle continues to drive.
    for (const LogChannel c : {LogChannel::kX, LogChannel::kY}) {
      for (std::size_t i = 1000; i < 1100; ++i) log[c]->fresh[i] = false;
    }
    const auto found = contradictions(log, vehicle(), {});
    EXPECT_TRUE(found.empty()) << seed << ": " << found.front().message;
  }
}

/// A small rover turns by more than a radian within a window of one second.
TEST(LogConsistency, NamesAMirroredYOfAVehicleThatTurnsQuickly) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrivingLog log = sound_log(seed, {.sides_apart = false});
    double psi = 0.0, x = 0.0, y = 0.0;
    for (std::size_t i = 0; i < log.rows(); ++i) {
      const double rate = 1.8 + 0.3 * std::sin(0.01 * static_cast<double>(i));
      channel(log, LogChannel::kHeading)[i] = psi;
      channel(log, LogChannel::kYawRate)[i] = rate;
      channel(log, LogChannel::kX)[i] = x;
      channel(log, LogChannel::kY)[i] = -y;
      psi += kStep_s * rate;
      x += kStep_s * channel(log, LogChannel::kSpeed)[i] * std::cos(psi);
      y += kStep_s * channel(log, LogChannel::kSpeed)[i] * std::sin(psi);
    }
    const auto found = contradictions(log, vehicle(), {});
    EXPECT_TRUE(std::ranges::any_of(found, [](const auto& c) { return c.column == "y_m"; }))
        << seed;
  }
}

TEST(LogConsistency, MirroredPositionsAreNamedByTheYawRateWithoutAHeading) {
  const std::function<void(DrivingLog&)> mirrors[] = {
      [](DrivingLog& l) { scale(channel(l, LogChannel::kY), -1.0); },
      [](DrivingLog& l) { std::swap(l[LogChannel::kX], l[LogChannel::kY]); }};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const auto& mirror : mirrors) {
      DrivingLog log = sound_log(seed, {.heading = false, .gyro_bias_radps = 0.01});
      mirror(log);
      const auto found = contradictions(log, vehicle(), {});
      ASSERT_EQ(found.size(), 1U) << seed;
      EXPECT_EQ(found.front().column, "y_m") << seed;
    }
  }
}

TEST(LogConsistency, MirroredPositionsAreNamedWhereTheVehicleReverses) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrivingLog log = sound_log(seed, {.heading = false});
    double psi = 0.0, x = 0.0, y = 0.0;
    for (std::size_t i = 0; i < log.rows(); ++i) {
      double& speed = channel(log, LogChannel::kSpeed)[i];
      if (i / 300 % 2 == 1) {
        speed = -speed;
        const double both = log.force_left[i] + log.force_right[i];
        log.force_left[i] -= both;
        log.force_right[i] -= both;
        (*log.steering_command_rad)[i] *= -1.0;
      }
      channel(log, LogChannel::kX)[i] = x;
      channel(log, LogChannel::kY)[i] = -y;
      psi += kStep_s * channel(log, LogChannel::kYawRate)[i];
      x += kStep_s * speed * std::cos(psi);
      y += kStep_s * speed * std::sin(psi);
    }
    const auto found = contradictions(log, vehicle(), {});
    ASSERT_EQ(found.size(), 1U) << seed;
    EXPECT_EQ(found.front().column, "y_m") << seed;
  }
}

TEST(LogConsistency, TheHeadingOfACompassBesideALatitudeIsTurnedToTheEast) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrivingLog log = sound_log(seed);
    log.is_geographic = true;
    for (double& heading : channel(log, LogChannel::kHeading)) heading = radians(90.0) - heading;
    const auto found = contradictions(log, vehicle(), {});
    ASSERT_EQ(found.size(), 1U) << seed;
    EXPECT_EQ(found.front().mapping, "heading_deg=\"heading_deg\"*-1+90") << seed;
  }
}

TEST(LogConsistency, OfTwoColumnsThatEitherExplainItOnlyOneIsToBeMapped) {
  DrivingLog log = sound_log(1, {.position = false, .heading = false, .sides_apart = false});
  scale(channel(log, LogChannel::kYawRate), -1.0);
  const auto found = contradictions(log, vehicle(), {});
  ASSERT_EQ(found.size(), 2U);
  for (const Contradiction& one : found) {
    EXPECT_THAT(one.message, HasSubstr("steering_cmd_deg, or yaw_rate_radps"));
  }
}

TEST(LogConsistency, ColumnsThatAreWrongTogetherAreNamedTogether) {
  DrivingLog log = sound_log(1, {.position = false});
  scale(channel(log, LogChannel::kYawRate), -1.0);
  scale(channel(log, LogChannel::kHeading), -1.0);
  const auto found = contradictions(log, vehicle(), {});
  ASSERT_GE(found.size(), 3U);
  for (const Contradiction& one : found) {
    EXPECT_THAT(one.message, HasSubstr("yaw_rate_radps and heading_deg"));
  }
}

TEST(LogConsistency, TheRemedyStartsFromTheFilesOwnColumn) {
  DrivingLog log = sound_log(1);
  scale(channel(log, LogChannel::kSpeed), 3.6);
  const ColumnMapping mappings[] = {{"speed_mps", "V (wheel)", 2.0, 0.0}};
  const auto found = contradictions(log, vehicle(), mappings);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().mapping, "speed_mps=\"V (wheel)\"*0.5555556");
}

TEST(LogConsistency, AFactorOfNoUnitHasNoMapping) {
  for (const double factor : {1.0 / 74.38188, 22.0, 1.0 / 4.2}) {
    DrivingLog log = sound_log(3);
    scale(channel(log, LogChannel::kYawRate), factor);
    const auto found = contradictions(log, vehicle(), {});
    ASSERT_FALSE(found.empty()) << factor;
    EXPECT_EQ(found.front().column, "yaw_rate_radps");
    EXPECT_EQ(found.front().mapping, "") << factor;
  }
  for (const double factor : {13.0, 1.0 / 7.7}) {
    DrivingLog log = sound_log(3);
    scale(channel(log, LogChannel::kSpeed), factor);
    const auto found = contradictions(log, vehicle(), {});
    const auto speed = std::ranges::find(found, "speed_mps", &Contradiction::column);
    ASSERT_NE(speed, found.end()) << factor;
    EXPECT_EQ(speed->mapping, "") << factor;
  }
}

TEST(LogConsistency, AWheelsRateAsSpeedNamesItsRadius) {
  DrivingLog log = sound_log(3);
  scale(channel(log, LogChannel::kSpeed), 60.0 / (2.0 * pi<double>() * 0.3));
  const auto found = contradictions(log, vehicle(), {});
  const auto speed = std::ranges::find(found, "speed_mps", &Contradiction::column);
  ASSERT_NE(speed, found.end());
  EXPECT_THAT(speed->message, HasSubstr("rpm of a wheel"));
}

TEST(LogConsistency, ASpeedOrRateThatNoVehicleHasIsImplausibleByItself) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrivingLog log = sound_log(seed, {.position = false, .heading = false});
    EXPECT_TRUE(contradictions(log, vehicle(), {}).empty()) << seed;
    scale(channel(log, LogChannel::kSpeed), 150.0);
    const auto speed = contradictions(log, vehicle(), {});
    ASSERT_FALSE(speed.empty()) << seed;
    EXPECT_EQ(speed.front().column, "speed_mps");
    EXPECT_THAT(speed.front().message, HasSubstr("implausible"));
    DrivingLog turning = sound_log(seed, {.position = false, .heading = false});
    scale(channel(turning, LogChannel::kYawRate), 180.0 / pi<double>());
    const auto rate = contradictions(turning, vehicle(), {});
    ASSERT_FALSE(rate.empty()) << seed;
    EXPECT_THAT(rate.back().mapping, HasSubstr("0.01745329"));
  }
}

TEST(LogConsistency, AGyroInDegreesIsFoundByTheSteeringAngleWithoutAHeading) {
  constexpr double kGently = 0.15;  // slow turns, so that also the rate in deg/s is plausible
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DrivingLog log =
        sound_log(seed, {.position = false, .heading = false, .sides_apart = false, .noise = 0.2});
    scale(*log.steering_command_rad, kGently);
    scale(channel(log, LogChannel::kYawRate), kGently);
    EXPECT_TRUE(contradictions(log, vehicle(), {}).empty()) << seed;
    scale(channel(log, LogChannel::kYawRate), 180.0 / pi<double>());
    const auto found = contradictions(log, vehicle(), {});
    ASSERT_EQ(found.size(), 1U) << seed;
    EXPECT_EQ(found.front().column, "yaw_rate_radps");
    EXPECT_THAT(found.front().mapping, HasSubstr("0.01745329"));
  }
}

TEST(LogConsistency, AGyroBiasIsMeasuredAgainstTheHeading) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const DrivingLog biased = sound_log(seed, {.gyro_bias_radps = 0.05});
    const auto bias = gyro_bias_radps(biased);
    ASSERT_TRUE(bias);
    EXPECT_NEAR(bias->value, 0.05, 5.0 * bias->std_error);
    EXPECT_FALSE(gyro_bias_radps(sound_log(seed)));
  }
}

TEST(LogConsistency, ALargeGyroBiasIsNoOtherUnit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const double bias_radps : {-0.4, 0.2, 0.6}) {
      const DrivingLog biased = sound_log(seed, {.gyro_bias_radps = bias_radps});
      for (const Contradiction& c : contradictions(biased, vehicle(), {})) {
        EXPECT_NE(c.column, "yaw_rate_radps") << seed << " " << bias_radps << ": " << c.message;
      }
    }
  }
}

TEST(LogConsistency, ASpeedThatIsStuckForHalfOfTheLogHasNoOtherUnit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    DrivingLog log = sound_log(seed);
    std::vector<double>& speed = log[LogChannel::kSpeed]->value;
    const std::size_t begin = 10 * seed;
    std::fill_n(speed.begin() + static_cast<std::ptrdiff_t>(begin), kRows / 2, speed[begin]);
    for (const Contradiction& c : contradictions(log, vehicle(), {})) {
      EXPECT_NE(c.column, "speed_mps") << seed << ": " << c.message;
    }
  }
}

TEST(LogConsistency, ARefusalNamesEachColumnWithItsRemedyAndAsIsTurnsItIntoAWarning) {
  DrivingLog log = sound_log(2);
  scale(*log.steering_command_rad, -1.0);
  std::vector<Finding> findings;
  const Status refused = check_consistency(log, "drive.csv", vehicle(), {}, findings);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kInput);
  EXPECT_EQ(refused.error().faults.front().place, "drive.csv");
  EXPECT_THAT(refused.error().faults.front().message, HasSubstr("steering_cmd_deg"));
  EXPECT_TRUE(
      check_consistency(log, "drive.csv", vehicle(), {.columns = {}, .as_is = true}, findings));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.front().code, "log-contradiction");
}

}  // namespace
}  // namespace awmr::log_consistency_test
