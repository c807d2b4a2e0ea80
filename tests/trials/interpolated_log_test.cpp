/// Logs whose columns a program interpolated between slower readings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "trial_text.h"

namespace awmr::testing {
namespace {

using ::testing::Contains;
using ::testing::Not;

constexpr double kDuration_s = 60.0;
constexpr double kRow_s = 0.02;

/// A signal that is known at some times, in ascending order.
struct Signal {
  std::vector<double> t_s, value;

  double interpolated(double at_s) const {
    const auto next = std::upper_bound(t_s.begin(), t_s.end(), at_s) - t_s.begin();
    if (next == 0) return value.front();
    if (next == static_cast<std::ptrdiff_t>(t_s.size())) return value.back();
    const auto i = static_cast<std::size_t>(next);
    const double share = (at_s - t_s[i - 1]) / (t_s[i] - t_s[i - 1]);
    return value[i - 1] + share * (value[i] - value[i - 1]);
  }
  double held(double at_s) const {
    const auto next = std::upper_bound(t_s.begin(), t_s.end(), at_s + 1e-9) - t_s.begin();
    return value[static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - 1, 0))];
  }
};

double motion(double t_s) { return 0.8 + 0.4 * std::sin(t_s) + 0.2 * std::sin(2.7 * t_s); }

/// Readings of motion() with noise; the times scatter by `jitter_s`.
Signal readings(double rate_hz, double jitter_s = 0.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Signal signal;
  for (double t = 0.0; t <= kDuration_s; t += 1.0 / rate_hz) {
    signal.t_s.push_back(t + jitter_s * normal(random));
    signal.value.push_back(motion(t) + 0.02 * normal(random));
  }
  return signal;
}

/// Steps of a command at multiples of `step_s`.
Signal command_steps(double rate_hz, double step_s = 0.4) {
  Signal signal;
  for (double t = 0.0; t <= kDuration_s; t += 1.0 / rate_hz) {
    const double step = std::floor(t / step_s + 1e-9);
    signal.t_s.push_back(t);
    signal.value.push_back(0.1 * std::fmod(step * 7.0, 9.0));
  }
  return signal;
}

using Value = std::function<double(double t_s)>;

/// Text of a log with these columns, each a function of time.
std::string log_text(double row_s, const Value& force, const Value& speed, const Value& yaw_rate,
                     int digits = 5) {
  std::string text = "t_s,force_left,force_right,steering_cmd_deg,speed_mps,yaw_rate_radps\n";
  for (double t = 0.0; t < kDuration_s - 0.5; t += row_s) {
    text += fmt::format("{:.6f},{:.6f},{:.6f},0,{:.{}f},{:.{}f}\n", t, force(t), force(t), speed(t),
                        digits, yaw_rate(t), digits);
  }
  return text;
}

Value between(Signal signal) {
  return [signal = std::move(signal)](double t_s) { return signal.interpolated(t_s); };
}
Value held(Signal signal) {
  return [signal = std::move(signal)](double t_s) { return signal.held(t_s); };
}
Value noisy(unsigned seed) {
  auto random = std::make_shared<std::mt19937>(seed);
  return [random](double t_s) {
    return motion(t_s) + 0.02 * std::normal_distribution<double>()(*random);
  };
}

std::size_t fresh_count(const DrivingLog& log, LogChannel channel) {
  return static_cast<std::size_t>(log[channel]->fresh_count);
}

/// Median distance of the fresh values from the nearest reading in time.
double median_error(const DrivingLog& log, LogChannel channel, const Signal& signal) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    if (!log[channel]->fresh[i]) continue;
    const auto next = std::lower_bound(signal.t_s.begin(), signal.t_s.end(), log.t_s[i]);
    double smallest = 1.0;
    for (auto at = next - std::min<std::ptrdiff_t>(1, next - signal.t_s.begin());
         at != signal.t_s.end() && at <= next; ++at) {
      const auto k = static_cast<std::size_t>(at - signal.t_s.begin());
      smallest = std::min(smallest, std::abs(log[channel]->value[i] - signal.value[k]));
    }
    errors.push_back(smallest);
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

struct Rates {
  double readings_hz, rows_hz, jitter_s;
  int digits;
};

TEST(InterpolatedReadings, AreRecoveredAtManyRates) {
  for (const Rates& rates :
       {Rates{20.0, 50.0, 0.0, 5}, Rates{25.0, 50.0, 0.0, 5}, Rates{22.0, 50.0, 0.0, 5},
        Rates{30.0, 100.0, 0.0, 5}, Rates{10.0, 100.0, 0.0, 3}, Rates{5.0, 50.0, 0.0, 4},
        Rates{20.0, 50.0, 0.003, 6}}) {
    const Signal speed = readings(rates.readings_hz, rates.jitter_s, 1);
    const Signal yaw_rate = readings(rates.readings_hz, rates.jitter_s, 2);
    const auto read = accepted(read_log, log_text(
                                             1.0 / rates.rows_hz, [](double) { return 0.2; },
                                             between(speed), between(yaw_rate), rates.digits));
    ASSERT_THAT(codes_of(read.findings), Contains("interpolated-readings@0")) << rates.readings_hz;
    const double expected = rates.readings_hz * (kDuration_s - 0.5);
    EXPECT_GT(fresh_count(read.set, LogChannel::kSpeed), 0.85 * expected) << rates.readings_hz;
    EXPECT_LT(fresh_count(read.set, LogChannel::kSpeed), 1.03 * expected) << rates.readings_hz;
    EXPECT_LT(median_error(read.set, LogChannel::kSpeed, speed), 2.0 * std::pow(10, -rates.digits))
        << rates.readings_hz;
  }
}

TEST(InterpolatedReadings, ShareTheirRowsWithInterpolatedCommands) {
  constexpr double kRate_hz = 20.0;
  const Signal command = command_steps(kRate_hz);
  const auto read =
      accepted(read_log, log_text(kRow_s, between(command), between(readings(kRate_hz, 0.0, 1)),
                                  between(readings(kRate_hz, 0.0, 2))));
  const DrivingLog& log = read.set;
  EXPECT_NEAR(static_cast<double>(log.rows()), kRate_hz * (kDuration_s - 0.5), 0.02 * 1200);
  std::size_t right = 0;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    if (std::abs(log.force_left[i] - command.held(log.t_s[i] + 0.005)) < 1e-5) ++right;
  }
  EXPECT_GT(static_cast<double>(right), 0.97 * static_cast<double>(log.rows()));
  EXPECT_EQ(log.force_left, log.force_right);
}

TEST(InterpolatedReadings, OfOneChannelLeaveTheOthersAsTheyAre) {
  const Value yaw_rate = noisy(2);
  const Signal command = command_steps(50.0);
  const std::string text =
      log_text(kRow_s, held(command), between(readings(20.0, 0.0, 1)), yaw_rate);
  const auto read = accepted(read_log, text);
  const DrivingLog& log = read.set;
  EXPECT_THAT(codes_of(read.findings), Contains("interpolated-readings@0"));
  EXPECT_NEAR(static_cast<double>(fresh_count(log, LogChannel::kYawRate)),
              (kDuration_s - 0.5) / kRow_s, 1.0);
  EXPECT_TRUE(log.joined);
  for (std::size_t i = 0; i < log.rows(); ++i) {
    if (!log[LogChannel::kYawRate]->fresh[i]) continue;
    EXPECT_NEAR(log.force_left[i], command.held(log.t_s[i] + 1e-4), 1e-6) << log.t_s[i];
  }
  EXPECT_TRUE(std::ranges::is_sorted(log.t_s));
  EXPECT_EQ(std::ranges::adjacent_find(log.t_s), log.t_s.end());
}

TEST(InterpolatedReadings, GiveTheTimesAtWhichHeldCommandsChanged) {
  const Signal command = command_steps(20.0, 0.35);  // the row after 0.35 s is at 0.36 s
  const auto read =
      accepted(read_log, log_text(kRow_s, held(command), between(readings(20.0, 0.0, 1)),
                                  between(readings(20.0, 0.0, 2))));
  const DrivingLog& log = read.set;
  for (std::size_t i = 1; i < log.rows(); ++i) {
    if (log.force_left[i] == log.force_left[i - 1]) continue;
    const double steps = log.t_s[i] / 0.35;
    EXPECT_NEAR(steps, std::round(steps), 1e-3) << log.t_s[i];
  }
}

/// Readings of a vehicle that rests for the first `rest_s` seconds; the first is at `first_s`.
Signal readings_after_rest(double rate_hz, double first_s, double rest_s, unsigned seed) {
  Signal signal = readings(rate_hz, 0.0, seed);
  for (std::size_t i = 0; i < signal.t_s.size(); ++i) {
    signal.t_s[i] += first_s;
    if (signal.t_s[i] < rest_s) signal.value[i] = 0.0;
  }
  return signal;
}

/// The commands before the first reading and during a rest are those of the file.
TEST(InterpolatedReadings, KeepTheCommandsOfARest) {
  const auto force = [](double t_s) { return t_s < 9.71 ? 0.0 : 0.1; };
  const Signal speed = readings_after_rest(20.0, 0.013, 10.0, 1);
  const auto read = accepted(read_log, log_text(kRow_s, force, between(speed), noisy(2)));
  const DrivingLog& log = read.set;
  ASSERT_THAT(codes_of(read.findings), Contains("interpolated-readings@0"));
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double row_s = kRow_s * std::floor(log.t_s[i] / kRow_s + 1e-6);
    EXPECT_EQ(log.force_left[i], force(row_s)) << log.t_s[i];
    if (!log[LogChannel::kSpeed]->fresh[i]) continue;
    const double after = (log.t_s[i] - 0.013) * 20.0;
    EXPECT_NEAR(after, std::round(after), 0.01) << log.t_s[i];
  }
  EXPECT_NEAR(static_cast<double>(fresh_count(log, LogChannel::kSpeed)), 20.0 * 59.5, 10.0);
}

/// A jump of the clock while the vehicle rests is a gap, with no readings in it.
TEST(InterpolatedReadings, DoNotFillAGapOfTheFile) {
  Signal speed = readings(20.0);
  for (std::size_t i = 0; i < speed.t_s.size(); ++i) {
    if (speed.t_s[i] > 14.0 && speed.t_s[i] < 16.0) speed.value[i] = 0.0;
  }
  for (const double jump_s : {100.0, 1.7e9}) {
    std::string text = "t_s,force_left,force_right,steering_cmd_deg,speed_mps\n";
    for (double t = 0.0; t < 59.0; t += kRow_s) {
      text += fmt::format("{:.6f},0.2,0.2,0,{:.5f}\n", t < 15.0 ? t : t + jump_s,
                          speed.interpolated(t));
    }
    const auto read = accepted(read_log, text);
    EXPECT_LT(read.set.rows(), 1250U) << jump_s;
    for (const double t_s : read.set.t_s) {
      EXPECT_TRUE(t_s <= 15.0 || t_s >= 15.0 + jump_s - kRow_s) << t_s;
    }
  }
}

TEST(InterpolatedReadings, OfAColumnThatOnlyRisesAreRecovered) {
  Signal rising = readings(10.0);
  for (std::size_t i = 0; i < rising.t_s.size(); ++i) rising.value[i] += 2.0 * rising.t_s[i];
  const auto read =
      accepted(read_log, log_text(
                             kRow_s, [](double) { return 0.2; }, between(rising), noisy(2)));
  EXPECT_THAT(codes_of(read.findings), Contains("interpolated-readings@0"));
  EXPECT_NEAR(static_cast<double>(fresh_count(read.set, LogChannel::kSpeed)), 595.0, 10.0);
}

TEST(InterpolatedReadings, OfTwoRatesKeepTheirRates) {
  const auto read =
      accepted(read_log, log_text(
                             0.01, [](double) { return 0.2; }, between(readings(20.0, 0.0, 1)),
                             between(readings(10.0, 0.0, 2))));
  EXPECT_NEAR(static_cast<double>(fresh_count(read.set, LogChannel::kSpeed)), 1190.0, 20.0);
  EXPECT_NEAR(static_cast<double>(fresh_count(read.set, LogChannel::kYawRate)), 595.0, 10.0);
}

TEST(InterpolatedReadings, AreNotFoundWhereNothingWasInterpolated) {
  const auto constant = [](double) { return 0.2; };
  const auto rounded = [](double unit) {
    return [unit](double t_s) { return unit * std::round(motion(t_s) / unit); };
  };
  // Straight lines of unequal lengths: a vehicle whose acceleration changes at its commands.
  const auto ramps = [](double t_s) {
    return std::abs(std::fmod(t_s, 3.0) - 1.1) + 0.4 * std::fmod(t_s, 1.7);
  };
  // Response without noise to a command that changes every 0.12 s (6 rows).
  const auto responses = [](double t_s) {
    const double step = std::floor(t_s / 0.12 + 1e-9);
    return 0.3 * std::fmod(step * 5.0, 7.0) * (1.0 - std::exp(-(t_s - 0.12 * step) / 0.05));
  };
  const std::map<std::string, Value> signals{
      {"responses", responses},
      {"responses, rounded", [&](double t_s) { return 1e-3 * std::round(1e3 * responses(t_s)); }},
      {"noise", noisy(3)},
      {"no noise", motion},
      {"coarse", rounded(0.05)},
      {"fine", rounded(0.001)},
      {"slow", held(readings(10.0))},
      {"encoder", [](double t_s) { return std::round(20.0 * motion(t_s)) / 20.0; }},
      {"ramps", ramps}};
  for (const auto& [name, signal] : signals) {
    const auto read = accepted(read_log, log_text(kRow_s, constant, signal, signal, 15));
    EXPECT_THAT(codes_of(read.findings), Not(Contains("interpolated-readings@0"))) << name;
    EXPECT_NEAR(static_cast<double>(read.set.rows()), (kDuration_s - 0.5) / kRow_s, 1.0) << name;
  }
}

}  // namespace
}  // namespace awmr::testing
