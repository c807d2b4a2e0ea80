/// Worst-case damping and delay margin over the model's 95 % set, compared with random points of
/// the set and with simulations in time.
#include "awmr/tune/certificate.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "awmr/core/parallel.h"
#include "awmr/core/random.h"
#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/pole_placement.h"
#include "tune/vehicles.h"

namespace awmr::testing {
namespace {

/// Conditions of the certificate: its own latency and lag, yaw rates up to 30 deg/s.
ConstraintContext context_of(const Model& model) {
  const LoopConditions c = conditions_of(model.vehicle);
  return {.plant = model.plant().value(),
          .has_steering = model.vehicle.has_steering(),
          .sample_time_s = model.vehicle.sample_time_s,
          .speed_mps = 0.3,
          .fastest_radps = radians(30.0),
          .wheel_force = model.vehicle.wheel_force,
          .latency_s = std::max(c.heading_latency_s, c.yaw_rate_latency_s),
          .motor_time_constant_s = c.motor_time_constant_s};
}

/// A vehicle's gains by pole placement and their certificate, which takes most of the test's time.
/// Test parameters: a vehicle and the number of random points.
class CertificateOf : public ::testing::TestWithParam<std::tuple<TestVehicle, std::size_t>> {
 protected:
  void expect_attained_at_the_place_that_it_names() const;
  void expect_the_delay_margin_of_a_simulation_in_time() const;
  void expect_no_better_than_random_points(std::size_t count) const;

  SampledHeadingLoop loop_at(const WorstCase& worst, YawMode mode) const {
    Model there = model_;
    for (const auto& [id, value] : worst.parameters) there[id].value = value;
    return certified_loop(gains_, context_, there.plant().value(), worst.yaw_rate_radps, mode);
  }

 private:
  const Model model_ = model_of(std::get<0>(GetParam()));
  const ConstraintContext context_ = context_of(model_);
  const Gains<double> gains_ = place_poles(context_);
  const Certificate certificate_ = certify(model_, context_, {}, gains_).value();
};

void CertificateOf::expect_no_better_than_random_points(std::size_t count) const {
  const ConfidenceSet set = ConfidenceSet::make(model_).value();
  const Interval rates = examined_rates_radps(context_);
  ASSERT_EQ(certificate_.modes.size(), yaw_modes(model_.vehicle).size());
  for (const ModeCertificate& one : certificate_.modes) {
    std::vector<double> damping(count, 1.0);
    std::vector<double> margin_s(count, 1e9);
    parallel_for(count, 0, [&](std::size_t i) {
      // Half of the points are on the surface of the set, half inside it.
      Random random(7, i);
      std::vector<double> point(set.dimension());
      double square = 0.0;
      for (double& x : point) {
        x = random.normal();
        square += x * x;
      }
      const double radius =
          i % 2 == 0 ? 1.0 : std::pow(random.uniform(), 1.0 / static_cast<double>(set.dimension()));
      for (double& x : point) x *= radius / std::sqrt(square);
      const auto plant = set.plant_at(point);
      if (!plant) return;
      const double rate = rates.lo * std::pow(rates.hi / rates.lo, random.uniform());
      const SampledHeadingLoop loop = certified_loop(gains_, context_, *plant, rate, one.mode);
      damping[i] = damping_ratio(loop);
      if (i < count / 4) margin_s[i] = delay_margin_s(loop);
    });
    const double least_damping = *std::ranges::min_element(damping);
    const double least_margin_s = *std::ranges::min_element(margin_s);
    EXPECT_GE(least_damping, one.damping.value - kCertificateTolerance);
    EXPECT_GE(least_margin_s, one.delay_margin_s.value * (1.0 - kCertificateTolerance));
    fmt::print("{}, {}: damping {:.4f} (sampled {:.4f}), delay margin {:.4f} s (sampled {:.4f})\n",
               model_.vehicle.name, name_of(one.mode), one.damping.value, least_damping,
               one.delay_margin_s.value, least_margin_s);
  }
}

void CertificateOf::expect_attained_at_the_place_that_it_names() const {
  for (const ModeCertificate& one : certificate_.modes) {
    EXPECT_NEAR(damping_ratio(loop_at(one.damping, one.mode)), one.damping.value, 1e-9);
    EXPECT_NEAR(delay_margin_s(loop_at(one.delay_margin_s, one.mode)), one.delay_margin_s.value,
                1e-9);
  }
}

/// Growth of the loop's free motion: the largest |psi| in the last tenth of the time, divided by
/// that in the first tenth. The motion is integrated by Euler steps of 1/100 of a sample. A queue
/// with one command per step delays the held command.
double growth(const SampledHeadingLoop& loop, double delay_s, double time_s) {
  constexpr int kSteps = 100;
  const double h = loop.sample_time_s / kSteps;
  const double all_s = delay_s + loop.command_delay_s;
  const auto late = static_cast<std::size_t>(std::lround(all_s / h));
  const auto samples = static_cast<std::size_t>(time_s / loop.sample_time_s);
  std::vector<double> commands;  // one command per integration step
  double psi = 0.1, r = 0.0, servo = 0.0, motor = 0.0, y = 0.0;
  double early = 0.0, at_end = 0.0;
  for (std::size_t j = 0; j < samples; ++j) {
    const double k = loop.reaching_rate;
    const double s = (loop.lambda + k) * r + loop.lambda * k * psi;
    const double w = loop.fed_forward_rate * r - s - loop.observer_radps * r - y;
    y += loop.sample_time_s * loop.observer_radps * s;
    commands.insert(commands.end(), kSteps, w);
    for (std::size_t i = j * kSteps; i < (j + 1) * kSteps; ++i) {
      const double u = i >= late ? commands[i - late] : 0.0;
      const double direct = loop.motor_time_constant_s > 0.0 ? motor : u;
      const double moment =
          loop.input_gain * (loop.direct_share * direct + (1.0 - loop.direct_share) * servo);
      psi += h * r;
      r += h * (moment - loop.resistance_rate * r);
      servo += h * (u - servo) / loop.servo_time_constant_s;
      if (loop.motor_time_constant_s > 0.0) motor += h * (u - motor) / loop.motor_time_constant_s;
    }
    if (j < samples / 10) early = std::max(early, std::abs(psi));
    if (j >= samples - samples / 10) at_end = std::max(at_end, std::abs(psi));
  }
  return at_end / early;
}

void CertificateOf::expect_the_delay_margin_of_a_simulation_in_time() const {
  for (const ModeCertificate& one : certificate_.modes) {
    const WorstCase& worst = one.delay_margin_s;
    const SampledHeadingLoop loop = loop_at(worst, one.mode);
    // With a delay 5 % below or above the margin D, a pole is about 0.05 w D from the unit circle.
    // The motion decays or grows by a factor e in some 20/w; the simulated time has at least ten of
    // these.
    const double time_s = 400.0 * (worst.value + loop.command_delay_s + loop.sample_time_s);
    EXPECT_LT(growth(loop, 0.95 * worst.value, time_s), 0.5) << name_of(one.mode);
    EXPECT_GT(growth(loop, 1.05 * worst.value, time_s), 2.0) << name_of(one.mode);
  }
}

TEST_P(CertificateOf, IsTheWorstCaseOfTheSet) {
  expect_attained_at_the_place_that_it_names();
  expect_the_delay_margin_of_a_simulation_in_time();
  expect_no_better_than_random_points(std::get<1>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Short, CertificateOf,
                         ::testing::Combine(::testing::ValuesIn(test_vehicles()),
                                            ::testing::Values(4'000U)));
INSTANTIATE_TEST_SUITE_P(Long, CertificateOf,
                         ::testing::Combine(::testing::ValuesIn(test_vehicles()),
                                            ::testing::Values(20'000U)));

SampledHeadingLoop plain_loop() {
  return {.lambda = 2.5,
          .reaching_rate = 10.0,
          .resistance_rate = 20.0,
          .fed_forward_rate = 22.0,
          .input_gain = 1.1,
          .servo_time_constant_s = 0.05,
          .sample_time_s = 0.02,
          .direct_share = 0.5,
          .motor_time_constant_s = 0.02};
}

TEST(DampingRatio, ChangesContinuouslyWithTheDelay) {
  // The fastest pole that samples show has |s| = pi/T_s = 157 1/s, and zeta changes by no more over
  // a second of delay: by 1.6e-5 over 1e-7 s. With a wrong split of the delay, zeta would jump by
  // about 0.01.
  for (const double delay_s : {0.01, 0.02, 0.0333, 0.04}) {
    SampledHeadingLoop before = plain_loop();
    before.command_delay_s = delay_s - 5e-8;
    SampledHeadingLoop after = plain_loop();
    after.command_delay_s = delay_s + 5e-8;
    EXPECT_NEAR(damping_ratio(before), damping_ratio(after), 1.6e-5) << delay_s;
  }
}

TEST(DelayMargin, IsWhereTheLargestEigenvalueReachesTheCircle) {
  for (const double observer : {0.0, 1.0}) {
    for (const double present_s : {0.0, 0.02, 0.027}) {
      SampledHeadingLoop loop = plain_loop();
      loop.observer_radps = observer;
      loop.command_delay_s = present_s;
      const double margin_s = delay_margin_s(loop);
      ASSERT_GT(margin_s, 0.0);
      loop.command_delay_s = present_s + 0.9999 * margin_s;
      EXPECT_GT(damping_ratio(loop), 0.0) << observer << " " << present_s;
      loop.command_delay_s = present_s + 1.0001 * margin_s;
      EXPECT_LT(damping_ratio(loop), 0.0) << observer << " " << present_s;
    }
  }
}

/// With an ideal plant the open loop is L = (b s + c)/s^2, b = lambda + k, c = lambda k, with the
/// crossover frequency w and the delay margin D:
///   w^2 = (b^2 + sqrt(b^4 + 4 c^2))/2,   D = atan(b w/c)/w
/// To first order, sampling with T_s takes T_s/2 of the margin.
TEST(DelayMargin, TendsToThatOfTheContinuousLoop) {
  constexpr double kSample_s = 1e-4;
  const SampledHeadingLoop loop{.lambda = 2.0,
                                .reaching_rate = 5.0,
                                .servo_time_constant_s = 1.0,
                                .sample_time_s = kSample_s,
                                .direct_share = 1.0};
  const double b = 7.0;
  const double c = 10.0;
  const double w = std::sqrt((b * b + std::sqrt(b * b * b * b + 4.0 * c * c)) / 2.0);
  const double margin_s = std::atan(b * w / c) / w - kSample_s / 2.0;
  // The remaining error is of second order in w T_s = 7e-4.
  EXPECT_NEAR(delay_margin_s(loop), margin_s, 1e-6);
}

TEST(Certificate, OfAModelWithoutACovarianceIsThatOfItsOwnValues) {
  const Model model = paper_model();
  const ConstraintContext context = context_of(model);
  const Certificate certificate = certify(model, context, {}, kPaperGains).value();
  EXPECT_EQ(certificate.parameters, 0);
  for (const ModeCertificate& one : certificate.modes) {
    EXPECT_EQ(one.damping.parameters.front().second, 0.3028);
    double least = 1.0;
    for (const double rate : {one.yaw_rate_radps.lo, one.yaw_rate_radps.hi}) {
      least = std::min(least, damping_ratio(certified_loop(kPaperGains, context, context.plant,
                                                           rate, one.mode)));
    }
    EXPECT_LE(one.damping.value, least);
  }
}

TEST(Certificate, CoversTheYawRatesOfTheRunsOfEachMode) {
  const Model model = paper_model();
  const ConstraintContext context = context_of(model);
  const Interval examined = examined_rates_radps(context);
  std::vector<ModeScore> runs(3);
  runs[0].mode = YawMode::kDifferential;
  runs[0].metrics.yaw_rate_max_degps = 150.0;
  runs[1].mode = YawMode::kSteering;
  runs[1].metrics.yaw_rate_max_degps = 20.0;
  runs[2].mode = YawMode::kCombined;
  runs[2].metrics.yaw_rate_max_degps = 1e4;
  runs[2].has_failed = true;
  const Certificate certificate = certify(model, context, {}, kPaperGains, runs).value();
  for (const ModeCertificate& one : certificate.modes) {
    EXPECT_EQ(one.yaw_rate_radps.lo, examined.lo);
    const bool is_faster = one.mode == YawMode::kDifferential;
    EXPECT_EQ(one.yaw_rate_radps.hi, is_faster ? radians(150.0) : examined.hi);
    const SampledHeadingLoop loop =
        certified_loop(kPaperGains, context, context.plant, one.yaw_rate_radps.hi, one.mode);
    EXPECT_LE(one.damping.value, damping_ratio(loop));
    EXPECT_LE(one.delay_margin_s.value, delay_margin_s(loop));
  }
  EXPECT_EQ(certificate.yaw_rate_radps().hi, radians(150.0));
}

TEST(Certificate, CoversTheMassesThatAreOpen) {
  const Model model = model_of(test_vehicles()[4]);
  const ConstraintContext context = context_of(model);
  const Certificate empty = certify(model, context, {}, kPaperGains).value();
  const Certificate loaded =
      certify(model, context, {.mass_factors = {1.0, 2.0}}, kPaperGains).value();
  EXPECT_LE(loaded.damping_min(), empty.damping_min());
  EXPECT_LE(loaded.delay_margin_s(), empty.delay_margin_s());
  EXPECT_NE(loaded.damping_min(), empty.damping_min());
}

}  // namespace
}  // namespace awmr::testing
