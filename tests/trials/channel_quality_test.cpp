/// Slow and coarse sensors, spikes, stuck and saturated channels, tested on signals with known
/// defects.
#include "awmr/trials/checks/channel_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "awmr/core/random.h"

namespace awmr::channel_quality_test {
namespace {

double rounded(double value, double resolution) {
  return resolution * std::round(value / resolution);
}

constexpr double kRate_hz = 50.0;
constexpr std::size_t kRows = 2000;

std::vector<double> times() {
  std::vector<double> t_s;
  for (std::size_t i = 0; i < kRows; ++i) t_s.push_back(static_cast<double>(i) / kRate_hz);
  return t_s;
}

/// Signals of a drive: a command that changes every 1.2 s, and a speed that follows within 0.3 s.
struct Drive {
  std::vector<double> command;
  std::vector<double> speed;
};

Drive drive(std::uint64_t seed, double noise) {
  Random random(seed, 1);
  Drive d;
  double level = 0.5;
  double speed = 0.5;
  for (std::size_t i = 0; i < kRows; ++i) {
    if (i % 60 == 0) level = 0.2 + random.uniform();
    speed += (level - speed) / (0.3 * kRate_hz);
    d.command.push_back(level);
    d.speed.push_back(speed + noise * random.normal());
  }
  return d;
}

ChannelQuality evaluate(const Drive& d) { return channel_quality(times(), d.speed, d.command); }

std::size_t fresh_rows(const ChannelQuality& q) {
  return static_cast<std::size_t>(std::count(q.fresh.begin(), q.fresh.end(), true));
}

TEST(ChannelQuality, ASoundSensorCountsInEveryRow) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ChannelQuality q = evaluate(drive(seed, 0.02));
    EXPECT_EQ(q.repeats, Repeats::kNone);
    EXPECT_EQ(fresh_rows(q), kRows);
    EXPECT_TRUE(q.spikes.empty() && q.stuck.empty());
    EXPECT_EQ(q.saturated, 0U);
  }
}

TEST(ChannelQuality, ACoarseEncoderCountsInEveryRow) {
  for (const double quantum : {0.02, 0.05, 0.2}) {
    Drive d = drive(3, 0.01);
    for (double& u : d.speed) u = rounded(u, quantum);
    const ChannelQuality q = evaluate(d);
    EXPECT_EQ(q.repeats, Repeats::kCoarse) << quantum;
    EXPECT_NEAR(q.quantum, quantum, 1e-9);
    EXPECT_EQ(fresh_rows(q), kRows) << quantum;
  }
}

TEST(ChannelQuality, ASlowSensorCountsAtItsOwnRate) {
  for (const std::size_t every : {4U, 5U, 10U}) {
    Drive d = drive(4, 0.02);
    for (std::size_t i = 0; i < kRows; ++i) d.speed[i] = d.speed[i / every * every];
    const ChannelQuality q = evaluate(d);
    EXPECT_EQ(q.repeats, Repeats::kSlow) << every;
    EXPECT_NEAR(static_cast<double>(fresh_rows(q)), kRows / static_cast<double>(every), 2.0);
  }
}

/// Readings at `rate_hz`, each of which stays in the log until the next one.
TEST(ChannelQuality, ASensorOfAnyLowerRateCountsAtItsOwnRate) {
  for (const double resolution : {1e-5, 0.001}) {
    for (const double rate_hz : {20.0, 23.0, 25.0, 27.0, 30.0, 35.0, 40.0, 44.0}) {
      Drive d = drive(4, 0.02);
      const std::vector<double> all = d.speed;
      for (std::size_t i = 0; i < kRows; ++i) {
        const double readings = std::floor(rate_hz / kRate_hz * static_cast<double>(i) + 0.3);
        const double row = std::ceil((readings - 0.3) * kRate_hz / rate_hz);
        d.speed[i] = rounded(all[static_cast<std::size_t>(std::max(0.0, row))], resolution);
      }
      const ChannelQuality q = evaluate(d);
      EXPECT_EQ(q.repeats, Repeats::kSlow) << rate_hz << ' ' << resolution;
      EXPECT_NEAR(static_cast<double>(fresh_rows(q)), kRows * rate_hz / kRate_hz, 0.03 * kRows)
          << rate_hz << ' ' << resolution;
    }
  }
}

TEST(ChannelQuality, EqualReadingsByRoundingAreNotThoseOfASlowSensor) {
  for (const double resolution : {0.002, 0.004, 0.006, 0.01, 0.02}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Drive d = drive(seed, 0.02);
      for (double& u : d.speed) u = rounded(u, resolution);
      EXPECT_EQ(fresh_rows(evaluate(d)), kRows) << resolution << ' ' << seed;
    }
  }
}

/// Speed of an encoder: the mean of the ticks of two wheels since the row before, in units that the
/// file rounds.
TEST(ChannelQuality, AnEncoderThatCountsTicksIsNotSlow) {
  Drive d = drive(7, 0.0);
  double left_m = 0.0, right_m = 0.0;
  double before = 0.0;
  for (std::size_t i = 0; i < kRows; ++i) {
    left_m += 0.97 * d.speed[i] / kRate_hz;
    right_m += 1.03 * d.speed[i] / kRate_hz;
    const double ticks = std::floor(left_m / 0.0049) + std::floor(right_m / 0.0049);
    d.speed[i] = rounded(0.5 * 0.0049 * (ticks - before) * kRate_hz, 1e-4);
    before = ticks;
  }
  EXPECT_EQ(fresh_rows(evaluate(d)), kRows);
}

/// Speed of an encoder: a tick divided by the time between the last two ticks. At low speed, it
/// changes less often.
TEST(ChannelQuality, AnEncoderThatTimesItsTicksHasNoRateOfItsOwn) {
  Drive d = drive(8, 0.0);
  constexpr double kTick_m = 0.013;
  double moved_m = 0.0, last_tick_s = 0.0, shown = 0.0;
  for (std::size_t i = 0; i < kRows; ++i) {
    const double before_m = moved_m;
    moved_m += d.speed[i] / kRate_hz;
    const double ticks = std::floor(moved_m / kTick_m) - std::floor(before_m / kTick_m);
    if (ticks > 0.0) {
      const double past_m = moved_m - kTick_m * std::floor(moved_m / kTick_m);
      const double tick_s = static_cast<double>(i) / kRate_hz - past_m / d.speed[i];
      shown = rounded(ticks * kTick_m / (tick_s - last_tick_s), 1e-4);
      last_tick_s = tick_s;
    }
    d.speed[i] = shown;
  }
  EXPECT_EQ(evaluate(d).repeats, Repeats::kNone);
}

/// A slowly moving signal reaches the next step of the resolution at irregular times, often several
/// rows apart.
TEST(ChannelQuality, ACoarseSensorWithoutNoiseIsNotTakenForASlowOne) {
  for (const double quantum : {0.05, 0.1, 0.2}) {
    Drive d = drive(6, 0.0);
    for (std::size_t i = 0; i < kRows; ++i) {
      const double t_s = 0.02 * static_cast<double>(i);
      d.speed[i] = rounded(1.0 + std::sin(0.4 * t_s), quantum);
    }
    const ChannelQuality q = evaluate(d);
    EXPECT_EQ(q.repeats, Repeats::kCoarse) << quantum;
    EXPECT_NEAR(q.quantum, quantum, 1e-9);
    EXPECT_EQ(fresh_rows(q), kRows) << quantum;
  }
}

TEST(ChannelQuality, ASlowAndCoarseSensorCountsWhereItRepeatsToo) {
  Drive d = drive(5, 0.0);
  for (std::size_t i = 0; i < kRows; ++i) {
    d.speed[i] = rounded(d.speed[i / 5 * 5], 0.02);
  }
  const ChannelQuality q = evaluate(d);
  EXPECT_EQ(q.repeats, Repeats::kSlow);
  // A new reading every 5 rows, except next to long repeats.
  EXPECT_NEAR(static_cast<double>(fresh_rows(q)), kRows / 5.0, kRows / 50.0);
}

TEST(ChannelQuality, SpikesAreFoundAndNothingElseIs) {
  Drive d = drive(6, 0.02);
  const std::vector<std::size_t> wild = {100, 333, 334, 1500};
  for (const std::size_t i : wild) d.speed[i] += 3.0;
  const ChannelQuality q = evaluate(d);
  EXPECT_EQ(q.spikes, wild);
  EXPECT_EQ(fresh_rows(q), kRows - wild.size());
}

TEST(ChannelQuality, NoiseAloneHasNoSpikes) {
  // A reading is a spike by chance with a probability of 1e-9, so none of the 3,000 channels has
  // one.
  int alarms = 0;
  for (const std::size_t rows : {60U, 300U, 2000U}) {
    for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
      Random random(seed, 3);
      std::vector<double> t_s, value, command;
      for (std::size_t i = 0; i < rows; ++i) {
        t_s.push_back(static_cast<double>(i) / kRate_hz);
        value.push_back(random.normal());
        command.push_back(i % 50 < 25 ? 0.3 : 0.5);
      }
      alarms += channel_quality(t_s, value, command).spikes.empty() ? 0 : 1;
    }
  }
  EXPECT_EQ(alarms, 0);
}

TEST(ChannelQuality, SharpTurnsOfAMotionAreNoSpikes) {
  // The speed has a triangle of two rows up and two down once a second, far above the noise. The
  // position sensor is slow: six readings per circle, between rests.
  Drive d = drive(9, 0.001);
  for (std::size_t i = 50; i + 4 < kRows; i += 50) {
    for (std::size_t k = 0; k < 5; ++k)
      d.speed[i + k] += 2.0 * (2.0 - std::abs(static_cast<double>(k) - 2.0));
  }
  EXPECT_TRUE(evaluate(d).spikes.empty());
  std::vector<double> t_s, position, command;
  for (std::size_t i = 0; i < 400; ++i) {
    position.push_back(std::cos(static_cast<double>(std::min<std::size_t>(i % 100, 30))));
    t_s.push_back(static_cast<double>(i));
    command.push_back(i % 50 < 25 ? 0.3 : 0.5);
  }
  EXPECT_TRUE(channel_quality(t_s, position, command).spikes.empty());
}

TEST(ChannelQuality, AnEdgeOfTheSignalIsNoSpike) {
  Drive d = drive(7, 0.001);
  for (std::size_t i = 1000; i < kRows; ++i) d.speed[i] += 5.0;
  EXPECT_TRUE(evaluate(d).spikes.empty());
}

TEST(ChannelQuality, AStuckSensorIsSetAsideAfterItsFirstReading) {
  Drive d = drive(8, 0.02);
  for (std::size_t i = 701; i < 1000; ++i) d.speed[i] = d.speed[700];
  const ChannelQuality q = evaluate(d);
  ASSERT_EQ(q.stuck.size(), 1U);
  EXPECT_EQ(q.stuck[0].begin, 700U);
  EXPECT_EQ(q.stuck[0].end, 1000U);
  EXPECT_EQ(fresh_rows(q), kRows - 299);
}

TEST(ChannelQuality, RestIsNotStuck) {
  Drive d = drive(9, 0.02);
  for (std::size_t i = 700; i < 1000; ++i) d.speed[i] = 0.0;
  EXPECT_TRUE(evaluate(d).stuck.empty());
}

TEST(ChannelQuality, RestIsNotStuckForTinyNumbers) {
  for (const double rest : {3.9e-312, -1e-15, 1e-9}) {
    Drive d = drive(9, 0.02);
    for (std::size_t i = 700; i < 1000; ++i) d.speed[i] = rest;
    EXPECT_TRUE(evaluate(d).stuck.empty()) << rest;
  }
}

/// Spans of zeros that find_stuck_at_zero() finds.
std::vector<RowSpan> stuck_at_zero(const Drive& d) {
  ChannelQuality q = evaluate(d);
  find_stuck_at_zero(times(), d.speed, d.command, q);
  std::size_t stuck = 0;
  for (const RowSpan& span : q.stuck_at_zero) {
    stuck += span.end - span.begin;
    for (std::size_t i = span.begin; i < span.end; ++i) EXPECT_FALSE(q.fresh[i]);
  }
  EXPECT_LE(fresh_rows(q), kRows - stuck);
  return q.stuck_at_zero;
}

TEST(ChannelQuality, ZerosOfAStuckSensorAreFound) {
  // The sensor is stuck in the middle, twice, and until the end.
  const std::vector<std::vector<RowSpan>> cases{
      {{700, 1000}}, {{300, 550}, {1100, 1350}}, {{1700, kRows}}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const std::vector<RowSpan>& spans : cases) {
      Drive d = drive(seed, 0.02);
      // A fast vehicle that accelerates from rest in the first 2 s.
      for (std::size_t i = 0; i < kRows; ++i) {
        d.speed[i] = (d.speed[i] + 0.3) * std::min(1.0, 0.01 * static_cast<double>(i));
      }
      for (const auto& [begin, end] : spans) {
        for (std::size_t i = begin; i < end; ++i) d.speed[i] = 0.0;
      }
      const std::vector<RowSpan> found = stuck_at_zero(d);
      ASSERT_EQ(found.size(), spans.size()) << seed;
      EXPECT_EQ(found.front().begin, spans.front().begin);
      EXPECT_EQ(found.back().end, spans.back().end);
    }
  }
}

/// Vehicle that stands for 4 s, with commands in its dead zone, and then drives for 4 s.
struct StopAndGo {
  std::uint64_t seed = 1;
  double time_constant_s = 0.3;  ///< of the speed
  double threshold = 0.0;        ///< the sensor reads smaller speeds as 0
  double resolution = 0.0;       ///< of the sensor; 0: noise instead
  double enabled_s = 0.0;        ///< time at which the motors are switched on
};

Drive stop_and_go(const StopAndGo& making) {
  Random random(making.seed, 4);
  Drive d;
  double level = 0.0;
  double speed = 0.0;
  for (std::size_t i = 0; i < kRows; ++i) {
    const double t_s = static_cast<double>(i) / kRate_hz;
    if (i % 50 == 0) level = (i / 200) % 2 == 0 ? 0.1 : 0.4 + 0.6 * random.uniform();
    const bool moves = level > 0.15 && t_s >= making.enabled_s;
    speed += ((moves ? level : 0.0) - speed) / std::max(1.0, making.time_constant_s * kRate_hz);
    const double read = making.resolution > 0.0 ? rounded(speed, making.resolution)
                                                : speed + 0.01 * random.normal();
    d.command.push_back(level);
    d.speed.push_back(std::abs(read) < making.threshold ? 0.0 : read);
  }
  return d;
}

TEST(ChannelQuality, ZerosOfAVehicleAtRestAreNotStuck) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const double enabled_s : {0.0, 6.0}) {
      for (const double time_constant_s : {0.3, 0.01}) {  // the short one: a jump in one row
        for (const double threshold : {0.05, 0.3}) {
          const Drive noisy = stop_and_go({seed, time_constant_s, threshold, 0.0, enabled_s});
          EXPECT_TRUE(stuck_at_zero(noisy).empty()) << seed << " " << threshold;
        }
        for (const double resolution : {0.001, 0.02, 0.2}) {
          const Drive encoder = stop_and_go({seed, time_constant_s, 0.0, resolution, enabled_s});
          EXPECT_TRUE(stuck_at_zero(encoder).empty()) << seed << " " << resolution;
        }
      }
    }
  }
}

/// A speed controller holds the speed within one quantisation step of the sensor, so the reading is
/// constant while the command changes with the ground.
TEST(ChannelQuality, ASteadySpeedThatIsKeptIsNotStuck) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed, 3);
    Drive d = drive(seed, 0.02);
    for (std::size_t i = 700; i < 1000; ++i) {
      d.speed[i] = 0.5;
      d.command[i] = d.command[700] + 0.4 * random.normal();
    }
    EXPECT_TRUE(evaluate(d).stuck.empty()) << seed;
  }
  Drive twice = drive(4, 0.02);
  for (const std::size_t begin : {300U, 1200U}) {
    for (std::size_t i = begin; i < begin + 200; ++i) twice.speed[i] = 0.5;
  }
  EXPECT_TRUE(evaluate(twice).stuck.empty());
}

TEST(ChannelQuality, RestingRowsAreNotSaturated) {
  for (const double rest : {-1e-13, 3.9e-312, -0.0125}) {
    Drive d = drive(10, 0.02);
    for (double& u : d.speed) u = std::abs(u);
    for (const std::size_t begin : {0U, 400U, 1500U}) {
      for (std::size_t i = begin; i < begin + 100; ++i) {
        d.command[i] = 0.0;
        d.speed[i] = rest;
      }
    }
    EXPECT_EQ(evaluate(d).saturated, 0U) << rest;
  }
}

TEST(ChannelQuality, TheEndOfASensorsRangeIsSetAside) {
  Drive d = drive(10, 0.02);
  const double top = 0.8 * *std::max_element(d.speed.begin(), d.speed.end());
  for (double& u : d.speed) u = std::min(u, top);
  const ChannelQuality q = evaluate(d);
  EXPECT_GT(q.saturated, 20U);
  EXPECT_EQ(q.saturated_at, top);
}

/// Rounds a signal to multiples of `step`, and keeps only the values that differ from the one
/// before.
std::vector<double> only_changes(const std::vector<double>& signal, double step) {
  std::vector<double> changes;
  for (const double x : signal) {
    const double reading = rounded(x, step);
    if (changes.empty() || reading != changes.back()) changes.push_back(reading);
  }
  return changes;
}

TEST(ChannelQuality, KnowsReadingsThatWereWrittenOnlyWhenTheyChanged) {
  constexpr double kStep = 0.01;
  std::vector<double> slow;
  for (int i = 0; i < 3000; ++i) slow.push_back(std::sin(0.004 * i));
  EXPECT_NEAR(resolution_of_changes(only_changes(slow, kStep)), kStep, 1e-9);
  // Readings at regular times (`regular`) repeat values. Those of an unrounded (`slow`) or fast
  // signal do not repeat, but their changes are not single steps of one resolution.
  std::vector<double> regular;
  std::vector<double> fast;
  for (int i = 0; i < 3000; ++i) {
    regular.push_back(rounded(slow[static_cast<std::size_t>(i)], kStep));
    fast.push_back(rounded(std::sin(0.7 * i), kStep));
  }
  EXPECT_EQ(resolution_of_changes(regular), 0.0);
  EXPECT_EQ(resolution_of_changes(slow), 0.0);
  EXPECT_EQ(resolution_of_changes(fast), 0.0);
}

}  // namespace
}  // namespace awmr::channel_quality_test
