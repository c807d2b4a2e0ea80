#include "awmr/tune/loop_stability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "awmr/tune/sampled_loop.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SampledHeadingLoop speed_loop_with(double gain_per_s, double resistance_rate) {
  return {.reaching_rate = gain_per_s,
          .resistance_rate = resistance_rate,
          .fed_forward_rate = resistance_rate,
          .servo_time_constant_s = 0.02,
          .sample_time_s = 0.1,
          .direct_share = 1.0};
}

TEST(SpeedLoop, IsStableUpToTheGainOfItsOnlyPole) {
  // Without lag and latency, the pole is z = 1 - k (1 - exp(-a T_s))/a, so the loop is stable below
  // k = 2 a/(1 - exp(-a T_s)), which is 2/T_s for a -> 0.
  for (const double a : {1e-9, 1.0, 50.0}) {
    const double limit = 2.0 * a / -std::expm1(-a * 0.1);
    EXPECT_GT(speed_damping_ratio(speed_loop_with(0.999 * limit, a)), 0.0) << a;
    EXPECT_LT(speed_damping_ratio(speed_loop_with(1.001 * limit, a)), 0.0) << a;
  }
}

/// Growth per sample of the speed loop with a latency of n samples, from its difference equation
///   x_(j+1) = phi x_j + (1 - phi)/a (a - k) x_(j-n),   phi = exp(-a T_s).
double growth_with_latency(const SampledHeadingLoop& loop, std::size_t n) {
  const double phi = std::exp(-loop.resistance_rate * loop.sample_time_s);
  const double gamma = (1.0 - phi) / loop.resistance_rate;
  std::vector<double> x(n + 1, 1.0);
  double log_size = 0.0;
  constexpr int kSamples = 4000;
  for (int j = 0; j < kSamples; ++j) {
    const double next =
        phi * x.back() + gamma * (loop.fed_forward_rate - loop.reaching_rate) * x.front();
    x.erase(x.begin());
    x.push_back(next);
    double size = 0.0;
    for (const double value : x) size = std::max(size, std::abs(value));
    for (double& value : x) value /= size;
    if (j >= kSamples / 2) log_size += std::log(size);
  }
  return std::exp(log_size / (kSamples / 2));
}

TEST(SpeedLoop, IsStableExactlyWhereItsLateMotionDecays) {
  int unstable = 0;
  for (const int late : {1, 2, 5}) {
    for (const double a : {0.5, 5.0, 50.0}) {
      for (const double k : {0.5, 2.0, 5.0, 20.0, 80.0}) {
        SampledHeadingLoop loop = speed_loop_with(k, a);
        loop.command_delay_s = late * loop.sample_time_s;
        const bool is_stable = speed_damping_ratio(loop) > 0.0;
        EXPECT_EQ(is_stable, growth_with_latency(loop, static_cast<std::size_t>(late)) < 1.0)
            << late << " " << a << " " << k;
        unstable += is_stable ? 0 : 1;
      }
    }
  }
  EXPECT_GT(unstable, 10);
  EXPECT_LT(unstable, 40);
}

TEST(UnstableLoops, AreNoneWithThePapersGains) {
  EXPECT_THAT(unstable_loops(paper_model(), kPaperGains, kIdealConditions), IsEmpty());
}

/// A slow vehicle of 60 kg whose yaw resistance decays within a fifth of the sample time.
Model creeper() {
  Model model = paper_model();
  model.vehicle.mass_kg = 60.0;
  model.vehicle.sample_time_s = 0.1;
  model.vehicle.steering_time_constant_s = 0.3;
  model[ParameterId::kSteeringTimeConstant].value = 0.3;
  model[ParameterId::kSurgeAlpha].value = 20.0;
  model[ParameterId::kSurgeBeta].value = 1.0;
  model[ParameterId::kYawAlpha].value = 2.667;
  model[ParameterId::kYawBeta].value = 1.0;
  model[ParameterId::kMassNorm].value = 0.4;
  model[ParameterId::kInertiaNorm].value = 0.0547;
  model.vehicle.yaw_rate_max_degps = 8.0;
  return model;
}

TEST(UnstableLoops, CountTheResistanceOfTheVehicle) {
  // lambda + mu/epsilon is 37.5 1/s, above 2/T_s = 20 1/s. With the resistance rate a = 48.8 1/s, a
  // sampled loop without lags is stable up to 2 a/(1 - exp(-a T_s)) = 98 1/s.
  const Gains<double> fast{{0.4849, 37.0 * 0.1446, 0.1446}, {0.807, 0.7822}};
  Model model = creeper();
  EXPECT_THAT(unstable_loops(model, fast, kIdealConditions), IsEmpty());
  const Gains<double> faster{{0.4849, 150.0 * 0.1446, 0.1446}, {0.807, 0.7822}};
  const auto unstable = unstable_loops(model, faster, kIdealConditions);
  ASSERT_THAT(unstable, SizeIs(1));
  EXPECT_THAT(unstable.front().name, HasSubstr("heading loop in mode"));
  EXPECT_NEAR(unstable.front().rate, 150.4849, 1e-9);
  const Gains<double> fast_speed{{0.4849, 5.0, 1.0}, {150.0, 1.0}};
  const auto speed = unstable_loops(model, fast_speed, kIdealConditions);
  ASSERT_THAT(speed, SizeIs(1));
  EXPECT_THAT(speed.front().name, HasSubstr("speed loop at"));
}

TEST(UnstableLoops, NameTheObserverIfTheLoopIsStableWithoutIt) {
  LoopConditions late = kIdealConditions;
  late.heading_latency_s = 0.1;
  late.speed_latency_s = 0.1;
  Gains<double> gains = kPaperGains;
  EXPECT_THAT(unstable_loops(paper_model(), gains, late), IsEmpty());
  // With a latency of 0.1 s, the observer alone is unstable above about (pi/2)/0.1 s = 16 rad/s.
  gains.observer = {50.0, 1.0, 1.0};
  const auto unstable = unstable_loops(paper_model(), gains, late);
  ASSERT_THAT(unstable, SizeIs(2));
  for (const UnstableLoop& loop : unstable) {
    EXPECT_THAT(loop.rate_name, HasSubstr("observer")) << loop.name;
    EXPECT_EQ(loop.rate, 50.0);
    EXPECT_EQ(loop.unit, "rad/s");
  }
  // lambda + mu/epsilon of 63 1/s is unstable without observer, too, at high yaw rates: there, the
  // rate of the yaw resistance is less than half of it. At 1 deg/s, the loop is stable without
  // observer.
  gains.heading.mu = 60.0 * gains.heading.epsilon;
  EXPECT_EQ(unstable_loops(paper_model(), gains, late).front().rate_name, "lambda + mu/epsilon");
}

TEST(UnstableLoops, CountTheLatencyOfTheSensors) {
  // With little resistance, the open heading loop is (7.2 s + 12.5)/s^2: lambda + k = 7.2 1/s and
  // lambda k = 12.5 1/s^2. Its gain is 1 at 7.4 rad/s, with a phase margin of 1.34 rad, so its
  // delay margin is 0.18 s, less half a sample of 0.01 s.
  Model model = paper_model();
  model[ParameterId::kYawAlpha].value = 0.0003;
  const auto unstable_at = [&](double heading_s, double speed_s) {
    LoopConditions late = kIdealConditions;
    late.heading_latency_s = heading_s;
    late.speed_latency_s = speed_s;
    return unstable_loops(model, kPaperGains, late, YawMode::kDifferential);
  };
  EXPECT_THAT(unstable_at(0.16, 0.0), IsEmpty());
  const auto heading = unstable_at(0.19, 0.0);
  ASSERT_THAT(heading, SizeIs(1));
  EXPECT_THAT(heading.front().name, HasSubstr("heading loop in mode differential"));
  // The open speed loop is 4.2/s, whose delay margin is (pi/2)/4.2 = 0.377 s, less half a sample.
  model[ParameterId::kSurgeAlpha].value = 0.0003;
  EXPECT_THAT(unstable_at(0.0, 0.36), IsEmpty());
  const auto speed = unstable_at(0.0, 0.39);
  ASSERT_THAT(speed, SizeIs(1));
  EXPECT_THAT(speed.front().name, HasSubstr("speed loop at"));
}

}  // namespace
}  // namespace awmr::testing
