#include "awmr/tune/constraints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "awmr/control/disturbance_observer.h"
#include "awmr/core/statistics/linear_algebra.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/pole_placement.h"
#include "awmr/tune/relaxation.h"
#include "awmr/tune/sampled_loop.h"
#include "awmr/tune/steering_rate.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

ConstraintContext paper_context(ReachingForm form, double margin) {
  return {.form = form,
          .margin = margin,
          .plant = paper_model().plant().value(),
          .sample_time_s = 0.01,
          .speed_mps = 1.0};
}

const ConstraintReport& named(const std::vector<ConstraintReport>& all, const std::string& name) {
  for (const ConstraintReport& c : all) {
    if (c.name == name) return c;
  }
  ADD_FAILURE() << "no constraint named " << name;
  return all.front();
}

// The constraints take a few operations on numbers below 50, so their relative rounding error is
// well below 1e-14.
constexpr double kRounding = 1e-13;

TEST(Constraints, GiveBothFormsOfT2BelowT1ForThePapersGains) {
  // T1 = 1/3 s, T2 = 12/(2 50) = 0.12 s, 2 T2 = 0.24 s; limit 0.8/3 = 0.26667 s
  const auto all = constraints_of(kPaperGains, paper_context(ReachingForm::kStrict, 0.8));
  const ConstraintReport paper = named(all, "T2 < T1 (paper)");
  const ConstraintReport strict = named(all, "T2 < T1 (strict)");
  EXPECT_NEAR(paper.value, 0.12, kRounding);
  EXPECT_NEAR(strict.value, 0.24, kRounding);
  EXPECT_NEAR(paper.limit, 0.8 / 3.0, kRounding);
  EXPECT_NEAR(strict.margin, 0.8 / 3.0 - 0.24, kRounding);
  EXPECT_TRUE(strict.required);
  EXPECT_FALSE(paper.required);
}

TEST(Constraints, RequireOnlyTheFormRequested) {
  // With the margin 0.5 the limit is 0.5 T1 = 0.1667 s: T2 = 0.12 s is below it, 2 T2 = 0.24 s is
  // not.
  const auto paper = constraints_of(kPaperGains, paper_context(ReachingForm::kPaper, 0.5));
  const auto strict = constraints_of(kPaperGains, paper_context(ReachingForm::kStrict, 0.5));
  EXPECT_LT(named(paper, "T2 < T1 (strict)").margin, 0.0);
  EXPECT_THAT(residuals(paper), ::testing::Each(::testing::Le(0.0)));
  EXPECT_THAT(residuals(strict), ::testing::Contains(::testing::Gt(0.0)));
}

TEST(Constraints, BoundTheSpeedLoopByHandFormulas) {
  // k_s = 5/1.2; k_s T_s = 0.041667; k_s (0.02 + 0.005) = 0.104167; 1/(4 0.49) = 0.510204
  const auto all = constraints_of(kPaperGains, paper_context(ReachingForm::kStrict, 0.8));
  EXPECT_NEAR(named(all, "speed gain").value, 0.05 / 1.2, kRounding);
  EXPECT_NEAR(named(all, "speed gain").limit, 0.5, kRounding);
  EXPECT_NEAR(named(all, "speed lag").value, 0.125 / 1.2, kRounding);
  EXPECT_NEAR(named(all, "speed lag").limit, 1.0 / 1.96, kRounding);
}

TEST(Constraints, RequireCorrectiveTermsThatDominate) {
  // 0.2 0.3028 (pi/3)^0.825/0.0128 and 0.2 1.3268/0.0768 at 1 m/s
  const auto all = constraints_of(kPaperGains, paper_context(ReachingForm::kStrict, 0.8));
  EXPECT_NEAR(named(all, "mu dominates").limit,
              0.2 * 0.3028 * std::pow(std::acos(-1.0) / 3.0, 0.825) / 0.0128, 1e-12);
  EXPECT_NEAR(named(all, "mu_s dominates").limit, 0.2 * 1.3268 / 0.0768, 1e-12);
}

TEST(Constraints, KeepCompassNoiseBelowAQuarterOfTheWeakerAuthority) {
  // Steering: 0.35 1.3268 tan(10 deg) m; differential: 4 0.36 (1 - 1.3268/4) m, larger.
  const ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  const double degree = std::acos(-1.0) / 180.0;
  EXPECT_NEAR(turning_authority_m(context.own(), context.speed_mps),
              0.35 * 1.3268 * std::tan(10.0 * degree), kRounding);
  const auto all = constraints_of(kPaperGains, context);
  EXPECT_NEAR(named(all, "noise gain").value, 0.0128 * 3.0 * 50.0 / 12.0 * degree, kRounding);
  EXPECT_NEAR(named(all, "noise gain").limit,
              turning_authority_m(context.own(), context.speed_mps) / 4.0, kRounding);
}

TEST(Constraints, KnowTheAuthorityOfFrontWheelDriveAndOfMotorsWithBackEmf) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.plant.rear_driven = 0.0;
  // Steering: l_f g1 tan(20 deg) = 0.169 m; differential: 2 0.36 (1 - 1.3268/2) = 0.242 m.
  EXPECT_NEAR(turning_authority_m(context.own(), context.speed_mps),
              0.35 * 1.3268 * std::tan(std::acos(-1.0) / 9.0), kRounding);
  context.plant.back_emf_s_per_m = 0.2;
  // At 1 m/s back-EMF takes another 0.2 of the voltage.
  EXPECT_NEAR(turning_authority_m(context.own(), context.speed_mps),
              2.0 * 0.36 * (1.0 - 1.3268 / 2.0 - 0.2), kRounding);
}

TEST(Constraints, IgnoreAModeWithoutAuthority) {
  // At rest steering has no authority; with F' at its upper limit the differential mode has none.
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.speed_mps = 0.0;
  EXPECT_NEAR(turning_authority_m(context.own(), context.speed_mps), 4.0 * 0.36, kRounding);
  context.speed_mps = 1.0;
  context.wheel_force = {0.0, 1.3268 / 4.0};
  EXPECT_NEAR(turning_authority_m(context.own(), context.speed_mps),
              0.35 * 1.3268 * std::tan(std::acos(-1.0) / 18.0), kRounding);
}

/// A limit that is far too strict is relaxed up to its default, 0.9 of the servo's rate.
TEST(RelaxedLimits, OfTheSteeringRateReachTheDefault) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.has_steering = true;
  context.servo_rate_degps = 300.0;
  for (const double strict : {0.1, 5.0, 100.0}) {
    context.limits.steering_rate_rms_degps = strict;
    double last = strict;
    for (const std::vector<RelaxedLimit>& numbers : relaxed_limits(context)) {
      for (const RelaxedLimit& limit : numbers) {
        if (!limit.is_steering_rate) continue;
        EXPECT_GT(limit.number, last);
        EXPECT_EQ(*limit.context.limits.steering_rate_rms_degps, limit.number);
        last = limit.number;
      }
    }
    EXPECT_GE(last, strict < 15.0 ? 0.9 * 300.0 : 5.0 * strict) << strict;
    EXPECT_LE(last, 2.0 * 300.0) << strict;
  }
}

TEST(Constraints, OfOneModeAreThoseOfItsActuationAlone) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.limits.steering_rate_rms_degps = 100.0;
  const auto all = constraints_of(kPaperGains, context);
  double worst = 1.0;
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering, YawMode::kCombined}) {
    context.mode = mode;
    worst = std::min(worst, named(constraints_of(kPaperGains, context), "heading damping").value);
  }
  EXPECT_EQ(worst, named(all, "heading damping").value);

  // The differential mode has no servo: the speed loop has only the lag T_s/2, and no constraint on
  // the steering rate.
  context.mode = YawMode::kDifferential;
  const auto differential = constraints_of(kPaperGains, context);
  EXPECT_NEAR(named(differential, "speed lag").value, 5.0 / 1.2 * 0.005, kRounding);
  EXPECT_EQ(differential.size() + 1, all.size());
  EXPECT_NEAR(named(differential, "noise gain").limit, 4.0 * 0.36 * (1.0 - 1.3268 / 4.0) / 4.0,
              kRounding);

  // In combined mode the steering makes half of the moment.
  context.mode = YawMode::kCombined;
  EXPECT_NEAR(named(constraints_of(kPaperGains, context), "steering rate").value,
              0.5 * named(all, "steering rate").value, 1e-9);
}

TEST(Constraints, HaveTheValueOfTheGainsAndTheLimitThatItMustKeep) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.latency_s = 0.02;
  const auto all = constraints_of(kPaperGains, context);
  for (const ConstraintReport& c : all) {
    const double margin = c.sense == Sense::kAtLeast ? c.value - c.limit : c.limit - c.value;
    EXPECT_EQ(c.margin, margin) << c.name;
  }
  EXPECT_EQ(named(all, "mu dominates").value, kPaperGains.heading.mu);
  EXPECT_EQ(named(all, "mu_s dominates").value, kPaperGains.speed.mu);
  EXPECT_EQ(named(all, "heading damping").limit, 0.7);
  EXPECT_EQ(named(all, "late damping").limit, 0.25);
  EXPECT_EQ(named(all, "T2 < T1 (strict)").value, 12.0 / 50.0);
}

TEST(Constraints, HoldForThePapersGains) {
  const auto all = constraints_of(kPaperGains, paper_context(ReachingForm::kStrict, 0.8));
  for (const ConstraintReport& c : all) {
    EXPECT_GE(c.margin, 0.0) << c.name << " " << c.value << " against " << c.limit;
  }
}

/// For the linear resistance g3 = a I'z r, the law turns the noise n (yaw rate) and n_psi (heading)
/// into the yaw acceleration w = (a - lambda - k) n - lambda k n_psi.
TEST(SteeringRate, IsThatOfIndependentReadingsThroughTheLaw) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.plant.yaw = {.alpha = 0.3, .beta = 1.0};
  context.heading_noise_rad = 0.02;
  context.yaw_rate_noise_radps = 0.01;
  const double a = 0.3 / 0.0128;
  const double k = 50.0 / 12.0;
  const double w = std::hypot(3.0 * k * 0.02, (a - 3.0 - k) * 0.01);
  const double per_moment = 2.0 / (0.35 * 1.3268);  // 2/(l_f g1(1 m/s))
  const double expected = per_moment * 0.0128 * std::sqrt(2.0) * w / 0.01 * 180.0 / std::acos(-1.0);
  // The midpoint rule over +-6 deviations neglects 1e-8 in the tails.
  EXPECT_NEAR(steering_rate_rms_degps(kPaperGains, context), expected, 1e-6 * expected);
  context.limits.steering_rate_rms_degps = expected - 1.0;
  EXPECT_LT(named(constraints_of(kPaperGains, context), "steering rate").margin, 0.0);
  context.has_steering = false;
  EXPECT_EQ(steering_rate_rms_degps(kPaperGains, context), 0.0);
}

/// RMS rate of the steering command for a million pairs of readings with the context's
/// correlations, deg/s. `law`: yaw acceleration w as a function of the noise of heading and yaw
/// rate, in standard deviations.
template <class Law>
double drawn_rate_degps(const ConstraintContext& context, const Law& law) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto after = [&](double reading, double correlation) {
    return correlation * reading + std::sqrt(1.0 - correlation * correlation) * normal(random);
  };
  double squares = 0.0;
  constexpr int kPairs = 1'000'000;
  for (int i = 0; i < kPairs; ++i) {
    const double heading = normal(random);
    const double rate = normal(random);
    const double change = law(after(heading, context.heading_correlation),
                              after(rate, context.yaw_rate_correlation)) -
                          law(heading, rate);
    squares += change * change;
  }
  const double per_moment = 2.0 / (context.plant.front_axle_m * context.plant.surge(1.0));
  return degrees(per_moment * context.plant.inertia_norm * std::sqrt(squares / kPairs) /
                 context.sample_time_s);
}

/// The RMS rate for the power law, for which w is nonlinear, equals that of a million correlated
/// pairs of readings.
TEST(SteeringRate, OfCorrelatedReadingsIsThatOfDrawnPairs) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.heading_noise_rad = 0.02;
  context.yaw_rate_noise_radps = 0.05;
  context.heading_correlation = 0.5;
  context.yaw_rate_correlation = 0.9;
  const double correlated = steering_rate_rms_degps(kPaperGains, context);
  const Resistance<double> g3 = feed_forward(context.plant.yaw);
  const double k = 50.0 / 12.0;
  const auto law = [&](double heading, double rate) {
    const double n = 0.05 * rate;
    return fed_forward(g3, n, 0.0) / context.plant.inertia_norm - (3.0 + k) * n -
           3.0 * k * 0.02 * heading;
  };
  const double drawn = drawn_rate_degps(context, law);
  // The series omits higher terms, so the rate is slightly too large and never too small.
  EXPECT_GT(correlated, 0.99 * drawn);
  EXPECT_LT(correlated, 1.05 * drawn);
}

/// Context of a steered vehicle with Coulomb friction in yaw: a 165 kg hauler if `is_heavy`,
/// otherwise an 18 kg rover.
ConstraintContext coulomb_context(bool is_heavy) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  Plant<double>& plant = context.plant;
  plant.yaw = is_heavy ? Resistance<double>{.alpha = 0.3015, .beta = 1.0, .coulomb = 0.04998}
                       : Resistance<double>{.alpha = 0.1208, .beta = 1.0, .coulomb = 0.02991};
  plant.inertia_norm = is_heavy ? 0.2697 : 0.05004;
  plant.steering_max_rad = 0.5;
  context.sample_time_s = is_heavy ? 0.04 : 0.01;
  return context;
}

/// RMS rate of the steering command in a simulated minute of a held heading, deg/s.
double simulated_rate_degps(const Gains<double>& gains, const ConstraintContext& context) {
  Scenario held{.name = "held", .guidance = HeadingSteps{{{0.0, 0.0}}}};
  held.duration_s = 60.0;
  held.initial.u_mps = held.speed_mps = context.speed_mps;
  held.sensors.emplace();
  held.sensors->heading.noise = context.heading_noise_rad;
  held.sensors->yaw_rate.noise = context.yaw_rate_noise_radps;
  Model model = paper_model();
  model.vehicle.sample_time_s = context.sample_time_s;
  const auto controller = make_controller(context.plant, model.vehicle, gains);
  SimulateOptions options;
  options.sample_time_s = context.sample_time_s;
  const Run run = simulate(context.plant, controller, held, YawMode::kSteering, options);
  return metrics_of(run, held, controller).steering_rate_rms_degps;
}

/// At rest the friction that the law feeds forward has the sign of the measured heading error, so
/// noise flips it.
TEST(SteeringRate, WithCoulombFrictionIsThatOfASimulatedHeldHeading) {
  for (const bool is_heavy : {false, true}) {
    ConstraintContext context = coulomb_context(is_heavy);
    for (const double noise_deg : {1.0, 0.2}) {
      context.heading_noise_rad = radians(noise_deg);
      context.yaw_rate_noise_radps = radians(noise_deg / 2.0);
      for (const double lambda : {2.0, 1.0, 0.3}) {
        for (const double width : {0.02, 0.06, 0.2}) {
          const Gains<double> gains{{lambda, 2.6 * lambda, 2.0, width}, {5.0, 1.2}};
          const double simulated = simulated_rate_degps(gains, context);
          EXPECT_NEAR(steering_rate_rms_degps(gains, context), simulated, 0.1 * simulated)
              << is_heavy << " " << noise_deg << " " << lambda << " " << width;
        }
      }
    }
  }
}

/// The RMS rate with Coulomb friction equals that of a million pairs of correlated readings, also
/// with slow noise.
TEST(SteeringRate, WithCoulombFrictionOfCorrelatedReadingsIsThatOfDrawnPairs) {
  ConstraintContext context = coulomb_context(false);
  context.heading_correlation = 0.95;
  context.yaw_rate_correlation = 0.6;
  const Gains<double> gains{{1.0, 5.2, 2.0, 0.03}, {5.0, 1.2}};
  const Resistance<double> g3 = feed_forward(context.plant.yaw, 0.03);
  const auto law = [&](double heading, double rate) {
    const double n = context.yaw_rate_noise_radps * rate;
    const double s = -n - context.heading_noise_rad * heading;  // lambda = 1
    return fed_forward(g3, n, s) / context.plant.inertia_norm - n + 2.6 * s;
  };
  const double drawn = drawn_rate_degps(context, law);
  // The computed rate is the larger one, because the series of the yaw-rate part omits higher
  // terms.
  EXPECT_NEAR(steering_rate_rms_degps(gains, context), drawn, 0.03 * drawn);
}

TEST(SteeringRate, AboveThatOfTheServoIsReported) {
  Vehicle vehicle = paper_vehicle();
  Plant<double> plant = paper_context(ReachingForm::kStrict, 0.8).plant;
  plant.steering_max_rad = radians(20.0);
  plant.steering_time_constant_s = 0.1;
  vehicle.steering_max_rate_degps = 150.0;
  EXPECT_EQ(servo_rate_degps(vehicle, plant), 150.0);
  Tuning tuning;
  EXPECT_FALSE(noise_beyond_servo(vehicle, plant, tuning));  // no limit, as with --nominal
  tuning.constraints = {{.name = kSteeringRate, .value = 149.0}};
  EXPECT_FALSE(noise_beyond_servo(vehicle, plant, tuning));
  tuning.constraints.front().value = 151.0;
  const auto finding = noise_beyond_servo(vehicle, plant, tuning);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->code, "noise-beyond-servo");
  // A first-order servo with T = 0.1 s turns at no more than 2 x 20 deg/0.1 s.
  vehicle.steering_max_rate_degps = 900.0;
  EXPECT_NEAR(servo_rate_degps(vehicle, plant), 400.0, 1e-9);
}

TEST(FrictionWidth, IsTheNarrowestThatKeepsTheSteeringRate) {
  ConstraintContext context = coulomb_context(true);
  const Gains<double> gains{{1.0, 2.6, 2.0}, {5.0, 1.2}};
  const auto rate_at = [&](double width) {
    Gains<double> there = gains;
    there.heading.friction_width_radps = width;
    return steering_rate_rms_degps(there, context);
  };
  context.fastest_radps = 2.0;
  const double widest = 10.0 * context.plant.yaw.coulomb / (context.plant.inertia_norm * 1.3);
  EXPECT_LT(rate_at(widest), 0.7 * rate_at(0.02));
  const auto width = [&](double wider = 0.0) {
    return with_friction_width(gains, context, wider).heading.friction_width_radps;
  };
  EXPECT_EQ(width(), 0.02);  // default width, because there is no limit of the steering rate
  context.limits.steering_rate_rms_degps = 1.01 * rate_at(0.02);
  EXPECT_EQ(width(), 0.02);
  context.limits.steering_rate_rms_degps = 0.5 * (rate_at(0.02) + rate_at(widest));
  EXPECT_LE(rate_at(width()), *context.limits.steering_rate_rms_degps);
  EXPECT_GT(rate_at(width() - 1e-5), *context.limits.steering_rate_rms_degps);
  EXPECT_LT(width(0.1), width());
  context.limits.steering_rate_rms_degps = 0.9 * rate_at(widest);
  EXPECT_NEAR(width(), widest, 1e-12);
  context.fastest_radps = 0.5;
  EXPECT_NEAR(width(), 0.5, 1e-12);
  context.plant.yaw.coulomb = 0.0;
  EXPECT_EQ(width(), 0.02);
}

/// The steering makes half of the moment in combined mode, so a narrower width meets the limit.
TEST(FrictionWidth, OfTheCombinedModeIsTheNarrowestThatKeepsTheSteeringRate) {
  ConstraintContext context = coulomb_context(true);
  context.fastest_radps = 2.0;
  const Gains<double> gains{{1.0, 2.6, 2.0}, {5.0, 1.2}};
  ConstraintContext combined = context;
  combined.mode = YawMode::kCombined;
  const double limit_degps = 0.9 * steering_rate_rms_degps(gains, combined);
  context.limits.steering_rate_rms_degps = combined.limits.steering_rate_rms_degps = limit_degps;
  Gains<double> found = with_friction_width(gains, context);
  const double width = found.friction_width_at(0.5);
  EXPECT_GT(width, 0.02);
  EXPECT_LT(width, 0.5 * found.friction_width_at(1.0));
  EXPECT_LE(steering_rate_rms_degps(found, combined), limit_degps);
  EXPECT_EQ(with_friction_width(gains, combined).friction_width_at(0.5), width);
  found.heading.combined_friction_width_radps = width - 1e-5;
  EXPECT_GT(steering_rate_rms_degps(found, combined), limit_degps);
  // The checked steering rate is that of the mode in which it is highest.
  found.heading.combined_friction_width_radps = 0.02;
  found.heading.friction_width_radps = 1e3;
  EXPECT_EQ(steering_rate_rms_degps(found, context), steering_rate_rms_degps(found, combined));
}

TEST(FrictionWidth, OfTheCombinedModeIsNotSearchedWithAnObserver) {
  ConstraintContext context = coulomb_context(true);
  Gains<double> gains{{1.0, 2.6, 2.0}, {5.0, 1.2}, {1.0, 0.1, 0.1}};
  context.limits.steering_rate_rms_degps = 0.9 * steering_rate_rms_degps(gains, context);
  gains = with_friction_width(gains, context);
  EXPECT_GT(gains.heading.friction_width_radps, 0.02);
  EXPECT_EQ(gains.heading.combined_friction_width_radps, 0.0);
  EXPECT_LE(steering_rate_rms_degps(gains, context), *context.limits.steering_rate_rms_degps);
}

/// The largest yaw moments come from the forces after subtracting the dead zone, as in
/// turning_moment().
TEST(Authority, IsOfTheForcesBeyondTheDeadZone) {
  DrawnVehicle vehicle{paper_plant(), {-0.05, 1.0}};
  vehicle.plant.wheel_dead_zone = 0.1;
  const Interval force = forces_beyond_dead_zone(vehicle);
  EXPECT_EQ(force.lo, 0.0);
  EXPECT_EQ(force.hi, 0.9);
  const double held = vehicle.plant.surge(0.5) / 4.0;
  EXPECT_NEAR(turning_authority_m(vehicle, 0.5, YawMode::kDifferential), 4.0 * 0.36 * held, 1e-12);
  EXPECT_NEAR(turning_authority_m(vehicle, 1.7, YawMode::kDifferential),
              4.0 * 0.36 * (0.9 - vehicle.plant.surge(1.7) / 4.0), 1e-12);
}

/// With the default width of the combined mode, half of w0, the combined mode has no more noise of
/// the steering command than the steering mode.
TEST(FrictionWidth, OfTheCombinedModeKeepsTheSteeringRateOfTheSteeringMode) {
  for (const bool is_heavy : {false, true}) {
    ConstraintContext context = coulomb_context(is_heavy);
    for (const double lambda : {2.0, 0.3}) {
      for (const double width : {0.02, 0.03, 0.06, 0.2, 1.0}) {
        const Gains<double> gains{{lambda, 2.6 * lambda, 2.0, width}, {5.0, 1.2}};
        context.mode = YawMode::kSteering;
        const double in_steering = steering_rate_rms_degps(gains, context);
        context.mode = YawMode::kCombined;
        EXPECT_LT(steering_rate_rms_degps(gains, context), in_steering) << lambda << " " << width;
      }
    }
  }
}

/// A wide w0, required by the noise of the steering command, must not leave a heading error in
/// differential mode, which does not steer.
TEST(FrictionWidth, OfTheDifferentialModeIsTheDefault) {
  const ConstraintContext context = coulomb_context(false);
  Model model = paper_model();
  const auto error_deg = [&](double width, YawMode mode) {
    Scenario turned{.name = "turned", .guidance = HeadingSteps{{{0.0, radians(30.0)}}}};
    turned.duration_s = 10.0;
    turned.initial.u_mps = turned.speed_mps = context.speed_mps;
    const Gains<double> gains{{2.0, 5.2, 2.0, width}, {5.0, 1.2}};
    SimulateOptions options;
    options.sample_time_s = context.sample_time_s;
    const auto run = simulate(context.plant, make_controller(context.plant, model.vehicle, gains),
                              turned, mode, options);
    return std::abs(30.0 - degrees(run.rows.back().state.psi_rad));
  };
  EXPECT_GT(error_deg(1.0, YawMode::kSteering), 2.0);
  EXPECT_LT(error_deg(1.0, YawMode::kDifferential), 0.6);
  EXPECT_EQ(error_deg(1.0, YawMode::kDifferential), error_deg(0.02, YawMode::kDifferential));
}

TEST(FrictionWidth, IsTheSameInAllModesWithAnObserver) {
  Gains<double> gains{{2.0, 5.2, 2.0, 0.3}, {5.0, 1.2}};
  EXPECT_EQ(gains.friction_width_at(0.0), 0.02);
  EXPECT_EQ(gains.friction_width_at(0.5), 0.15);
  EXPECT_EQ(gains.friction_width_at(1.0), 0.3);
  gains.heading.combined_friction_width_radps = 0.05;
  EXPECT_EQ(gains.friction_width_at(0.0), 0.02);
  EXPECT_EQ(gains.friction_width_at(0.5), 0.05);
  EXPECT_EQ(gains.friction_width_at(1.0), 0.3);
  gains.observer = {1.0, 0.1, 0.1};
  EXPECT_EQ(gains.friction_width_at(0.0), 0.3);
  EXPECT_EQ(gains.friction_width_at(0.5), 0.3);
}

/// No pair of poles whose slower pole is 5 % faster meets every constraint.
TEST(PolePlacement, IsTheFastestThatTheConstraintsAllow) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.latency_s = 0.02;
  context.limits.steering_rate_rms_degps = 270.0;
  const Gains<double> placed = place_poles(context);
  EXPECT_THAT(residuals(constraints_of(placed, context)), ::testing::Each(::testing::Le(0.0)));
  const auto all = constraints_of(placed, context);
  EXPECT_NEAR(named(all, "mu dominates").margin, 0.0, 1e-6);
  EXPECT_NEAR(named(all, "mu_s dominates").margin, 0.0, 1e-6);
  EXPECT_NEAR(named(all, "speed lag").margin, 0.0, 1e-6);
  for (double k = 1.0; k < 100.0; k *= 1.02) {
    Gains<double> faster = placed;
    faster.heading.lambda *= 1.05;
    faster.heading.epsilon = faster.heading.mu / k;
    EXPECT_THAT(residuals(constraints_of(faster, context)), ::testing::Contains(::testing::Gt(0.0)))
        << k;
  }
}

TEST(PolePlacement, KeepsTheConstraintsOfEachDraw) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  context.latency_s = 0.02;
  const double alone = place_poles(context).heading.lambda;
  Plant<double> slippery = context.plant;
  slippery.yaw.alpha *= 0.8;
  context.draws = {{slippery, context.wheel_force}};
  const Gains<double> placed = place_poles(context);
  EXPECT_LT(placed.heading.lambda, alone);
  EXPECT_THAT(residuals(constraints_of(placed, context)), ::testing::Each(::testing::Le(0.0)));
}

TEST(SampledLoop, IsTheDoubleIntegratorsWithoutResistanceAndServo) {
  // Without resistance (a = 0) and with direct forces (s = 1): psi+ = psi + T r + T^2/2 w,
  // r+ = r + T w, w = -(l + k) r - l k psi gives
  //   z^2 - (2 - T (l + k) - T^2/2 l k) z + (1 - T (l + k) + T^2/2 l k) = 0.
  // The servo adds its own real pole, damping 1.
  const double l = 8.0;
  const double k = 150.0;
  const double t = 0.01;
  const double b = 2.0 - t * (l + k) - t * t / 2.0 * l * k;
  const double c = 1.0 - t * (l + k) + t * t / 2.0 * l * k;
  const std::complex<double> root = std::sqrt(std::complex<double>(b * b / 4.0 - c));
  double expected = 1.0;
  for (const std::complex<double> z : {b / 2.0 + root, b / 2.0 - root}) {
    const std::complex<double> s = std::log(z);
    expected = std::min(expected, -s.real() / std::abs(s));
  }
  const double damping = damping_ratio({.lambda = l,
                                        .reaching_rate = k,
                                        .resistance_rate = 0.0,
                                        .fed_forward_rate = 0.0,
                                        .servo_time_constant_s = 0.02,
                                        .sample_time_s = t,
                                        .direct_share = 1.0});
  // Tolerance: well-separated eigenvalues of a 3 by 3 matrix with elements of about 1 have at most
  // a few hundred roundings.
  EXPECT_NEAR(damping, expected, 1e-10);
  EXPECT_LT(damping, 0.5);  // the pole z = -0.58 changes sign in every sample
}

TEST(SampledLoop, IsUnstableExactlyBeyondTheJuryBound) {
  // At the stability limit, z = -1 is a root of the polynomial above: 4 - 2 T (l + k) = 0 for every
  // l k, so l + k = 2/T = 200.
  const auto damping_at = [](double k) {
    return damping_ratio({.lambda = 3.0,
                          .reaching_rate = k,
                          .resistance_rate = 0.0,
                          .fed_forward_rate = 0.0,
                          .servo_time_constant_s = 0.02,
                          .sample_time_s = 0.01,
                          .direct_share = 1.0});
  };
  EXPECT_GT(damping_at(196.9), 0.0);
  EXPECT_LT(damping_at(197.1), 0.0);
}

TEST(SampledLoop, ApproachesTheContinuousLoopForShortSamples) {
  // For T_s and T -> 0, the roots are -lambda and -k. They are real and separate, so they stay real
  // under a perturbation of order h = 1e-5, and the damping ratio stays 1.
  const double damping = damping_ratio({.lambda = 3.0,
                                        .reaching_rate = 5.0,
                                        .resistance_rate = 20.0,
                                        .fed_forward_rate = 20.0,
                                        .servo_time_constant_s = 1e-5,
                                        .sample_time_s = 1e-5,
                                        .direct_share = 0.0});
  EXPECT_NEAR(damping, 1.0, 1e-6);
}

TEST(SampledLoop, LosesDampingWithLambdaPlusKTimesTheLag) {
  // (lambda + k)(T + T_s/2) = 1/(4 0.49) is the first-order bound for zeta 0.7 at lambda -> 0; the
  // hold's delay is T_s/2 to first order in T_s. The test compares this bound (0.510) with half and
  // twice its value.
  const auto damping_at = [](double product) {
    return damping_ratio({.lambda = 1e-3,
                          .reaching_rate = product / 0.0201,
                          .resistance_rate = 0.0,
                          .fed_forward_rate = 0.0,
                          .servo_time_constant_s = 0.02,
                          .sample_time_s = 0.0002,
                          .direct_share = 0.0});
  };
  // zeta = 1/(2 sqrt(product)); the neglected terms are T_s/T = 1 % and lambda/k < 1e-3.
  EXPECT_NEAR(damping_at(1.0 / 1.96), 0.7, 0.01);
  EXPECT_NEAR(damping_at(2.0 / 1.96), 0.7 / std::sqrt(2.0), 0.01);
  EXPECT_GT(damping_at(0.5 / 1.96), 0.98);
}

TEST(Constraints, TakeTheWorstDampingOfAllModesAndYawRates) {
  // The worst damping is that of steering mode (direct share 0); at k = 190, that of differential
  // mode (direct share 1). Combined mode is in between.
  const ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  for (const double k : {2.0, 10.0, 40.0, 120.0, 190.0}) {
    const Gains<double> gains{{3.0, k, 1.0}, {5.0, 1.2}};
    double worst = 1.0;
    for (const double rate_degps : {1.0, 5.0, 20.0, 60.0}) {
      const double rate = rate_degps * std::acos(-1.0) / 180.0;
      const double slope = 0.3028 * 0.825 * std::pow(rate, 0.825 - 1.0);
      for (const double share : {1.0, 0.5, 0.0}) {
        worst = std::min(worst, damping_ratio({.lambda = 3.0,
                                               .reaching_rate = k,
                                               .resistance_rate = slope / 0.0128,
                                               .fed_forward_rate = slope / 0.0128,
                                               .servo_time_constant_s = 0.02,
                                               .sample_time_s = 0.01,
                                               .direct_share = share}));
      }
    }
    EXPECT_NEAR(named(constraints_of(gains, context), "heading damping").value, worst, 1e-9) << k;
  }
}

/// Integrates the loop over one sample with a thousand Euler-Heun steps.
Eigen::Vector3d after_a_sample(const SampledHeadingLoop& loop, Eigen::Vector3d x) {
  const double w = (loop.fed_forward_rate - loop.lambda - loop.reaching_rate) * x(1) -
                   loop.lambda * loop.reaching_rate * x(0);
  const auto rates = [&](const Eigen::Vector3d& s) {
    return Eigen::Vector3d(
        s(1),
        -loop.resistance_rate * s(1) +
            loop.input_gain * (loop.direct_share * w + (1.0 - loop.direct_share) * s(2)),
        (w - s(2)) / loop.servo_time_constant_s);
  };
  constexpr int kSteps = 1000;
  const double h = loop.sample_time_s / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d first = rates(x);
    x += 0.5 * h * (first + rates(x + h * first));
  }
  return x;
}

/// Model of the plant (a = 25 1/s) on which the law is based. The test uses an exact model, one
/// with too small an inertia, and one with too large a resistance.
struct Known {
  double fed_forward_rate;
  double input_gain;
};
constexpr Known kKnown[] = {{25.0, 1.0}, {25.0, 0.4}, {32.0, 1.3}};

TEST(SampledLoop, IsTheEquationsOfItsHeaderWhateverTheDirectShare) {
  for (const Known& known : kKnown) {
    for (const double share : {0.0, 0.25, 0.5, 1.0}) {
      const SampledHeadingLoop loop{.lambda = 3.0,
                                    .reaching_rate = 20.0,
                                    .resistance_rate = 25.0,
                                    .fed_forward_rate = known.fed_forward_rate,
                                    .input_gain = known.input_gain,
                                    .servo_time_constant_s = 0.03,
                                    .sample_time_s = 0.01,
                                    .direct_share = share};
      Eigen::Matrix3d closed;
      for (int i = 0; i < 3; ++i) closed.col(i) = after_a_sample(loop, Eigen::Vector3d::Unit(i));
      double worst = 1.0;
      for (const std::complex<double> z : eigenvalues(closed)) {
        const std::complex<double> s = std::log(z);
        worst = std::min(worst, -s.real() / std::abs(s));
      }
      // Heun's error is h^2 a^2/6 of the motion in T_s, h = 1e-5 s and a up to 33/s: below 1e-7.
      EXPECT_NEAR(damping_ratio(loop), worst, 1e-5) << share << " " << known.input_gain;
    }
  }
}

/// Largest |z| of the loop with latency, motor lag and the observer of control/, from the growth of
/// its free motion.
double growth(const SampledHeadingLoop& loop) {
  struct Motion {
    double psi, r, servo, motor;
  };
  Motion x{1.0, 0.5, -0.3, 0.2};
  const auto late_samples =
      static_cast<std::size_t>(std::lround(loop.command_delay_s / loop.sample_time_s));
  std::vector<Motion> readings(late_samples + 1, x);
  constexpr int kSamples = 4000;
  constexpr int kSteps = 200;
  const double h = loop.sample_time_s / kSteps;
  double log_size = 0.0;
  const DisturbanceObserver<double> observer{loop.observer_radps, 1e300};
  ObserverState<double> observed{loop.observer_radps > 0.0 ? 0.1 : 0.0};
  for (int k = 0; k < kSamples; ++k) {
    readings.push_back(x);
    readings.erase(readings.begin());
    const Motion& late = readings.front();
    const double d_hat = estimate(observer, late.r, observed);
    const double w = (loop.fed_forward_rate - loop.lambda - loop.reaching_rate) * late.r -
                     loop.lambda * loop.reaching_rate * late.psi - d_hat;
    advance(observer, d_hat, w - loop.fed_forward_rate * late.r, loop.sample_time_s, observed);
    for (int i = 0; i < kSteps; ++i) {
      const auto rates = [&](const Motion& s) {
        return Motion{
            s.r,
            -loop.resistance_rate * s.r + loop.input_gain * (loop.direct_share * s.motor +
                                                             (1.0 - loop.direct_share) * s.servo),
            (w - s.servo) / loop.servo_time_constant_s, (w - s.motor) / loop.motor_time_constant_s};
      };
      const Motion a = rates(x);
      const Motion b =
          rates({x.psi + h * a.psi, x.r + h * a.r, x.servo + h * a.servo, x.motor + h * a.motor});
      x = {x.psi + 0.5 * h * (a.psi + b.psi), x.r + 0.5 * h * (a.r + b.r),
           x.servo + 0.5 * h * (a.servo + b.servo), x.motor + 0.5 * h * (a.motor + b.motor)};
    }
    // Scales the state regularly to avoid overflow and underflow.
    if (k % 100 != 99) continue;
    const double size = std::hypot(std::hypot(x.psi, x.r), std::hypot(x.servo, x.motor));
    if (k >= kSamples / 2) log_size += std::log(size);
    const auto scale = [size](Motion& m) {
      m = {m.psi / size, m.r / size, m.servo / size, m.motor / size};
    };
    scale(x);
    observed.z /= size;
    for (Motion& reading : readings) scale(reading);
  }
  return std::exp(log_size / (kSamples / 2));
}

TEST(SampledLoop, IsStableExactlyWhereItsLateMotionDecays) {
  for (const Known& known : kKnown) {
    for (const int late : {0, 2, 5}) {
      for (const double share : {0.0, 0.5, 1.0}) {
        for (const double k : {4.0, 12.0, 30.0}) {
          const SampledHeadingLoop loop{.lambda = 3.0,
                                        .reaching_rate = k,
                                        .resistance_rate = 25.0,
                                        .fed_forward_rate = known.fed_forward_rate,
                                        .input_gain = known.input_gain,
                                        .servo_time_constant_s = 0.03,
                                        .sample_time_s = 0.01,
                                        .direct_share = share,
                                        .motor_time_constant_s = late == 2 ? 0.05 : 0.01,
                                        .command_delay_s = 0.01 * late};
          EXPECT_EQ(damping_ratio(loop) > 0.0, growth(loop) < 1.0)
              << known.input_gain << " " << late << " " << share << " " << k;
        }
      }
    }
  }
}

TEST(SampledLoop, IsStableExactlyWhereItsMotionUnderAnObserverDecays) {
  int unstable = 0;
  for (const int late : {0, 2, 5}) {
    for (const double share : {0.0, 1.0}) {
      for (const double k : {4.0, 12.0, 30.0}) {
        for (const double observer_radps : {0.5, 4.0, 20.0, 60.0}) {
          const SampledHeadingLoop loop{.lambda = 3.0,
                                        .reaching_rate = k,
                                        .resistance_rate = 25.0,
                                        .fed_forward_rate = 25.0,
                                        .servo_time_constant_s = 0.03,
                                        .sample_time_s = 0.01,
                                        .direct_share = share,
                                        .motor_time_constant_s = 0.01,
                                        .observer_radps = observer_radps,
                                        .command_delay_s = 0.01 * late};
          EXPECT_EQ(damping_ratio(loop) > 0.0, growth(loop) < 1.0)
              << late << " " << share << " " << k << " " << observer_radps;
          unstable += damping_ratio(loop) > 0.0 ? 0 : 1;
        }
      }
    }
  }
  EXPECT_GT(unstable, 5);
  EXPECT_LT(unstable, 67);
}

TEST(SampledLoop, GainsTheRootOfItsObserverForShortSamples) {
  // The poles -lambda, -k and -L are real, separate, and far from the servo pole, so the damping
  // ratio is 1.
  const double damping = damping_ratio({.lambda = 3.0,
                                        .reaching_rate = 5.0,
                                        .resistance_rate = 20.0,
                                        .fed_forward_rate = 20.0,
                                        .servo_time_constant_s = 1e-5,
                                        .sample_time_s = 1e-5,
                                        .direct_share = 0.0,
                                        .observer_radps = 8.0});
  EXPECT_NEAR(damping, 1.0, 1e-6);
}

TEST(Constraints, CountAnObserverInTheSpeedLoop) {
  Gains<double> gains = kPaperGains;
  gains.observer = {6.0, 0.1, 1.0};
  const auto all = constraints_of(gains, paper_context(ReachingForm::kStrict, 0.8));
  EXPECT_NEAR(named(all, "speed gain").value, 0.01 * (5.0 / 1.2 + 6.0), kRounding);
  EXPECT_NEAR(named(all, "speed lag").value, 0.025 * (5.0 / 1.2 + 6.0), kRounding);
  EXPECT_THAT(named(all, "speed lag").meaning, ::testing::HasSubstr("+ L"));
}

TEST(Constraints, AreThoseOfThePlantWithTheSmallestMargin) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  const std::vector<ConstraintReport> own = constraints_of(kPaperGains, context);
  Plant<double> heavy = context.plant;
  heavy.yaw.alpha *= 1.5;  // more yaw resistance needs a larger mu
  context.draws = {context.own(), {heavy, context.wheel_force}};
  const std::vector<ConstraintReport> worst = constraints_of(kPaperGains, context);
  ASSERT_EQ(worst.size(), own.size());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_LE(worst[i].margin, own[i].margin + 1e-15);
  const auto mu = std::find_if(worst.begin(), worst.end(),
                               [](const auto& c) { return c.name == "mu dominates"; });
  const auto mu_alone =
      std::find_if(own.begin(), own.end(), [](const auto& c) { return c.name == "mu dominates"; });
  EXPECT_NEAR(mu->limit, 1.5 * mu_alone->limit, 1e-9);
}

TEST(Constraints, IncludeTheDifferenceOfADrawToTheModel) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  Plant<double> loaded = context.plant;  // the vehicle with a load of 150 % of its mass
  loaded.mass_norm *= 2.5;
  loaded.inertia_norm *= 2.5;
  Plant<double> light = context.plant;
  light.mass_norm *= 0.5;
  context.draws = {{loaded, context.wheel_force}, {light, {-0.5, 0.5}}};
  const auto all = constraints_of(kPaperGains, context);
  double worst = 1.0;
  for (const double rate_degps : {1.0, 5.0, 20.0, 60.0}) {
    const double rate = rate_degps * std::acos(-1.0) / 180.0;
    const double slope = 0.3028 * 0.825 * std::pow(rate, 0.825 - 1.0);
    for (const double share : {1.0, 0.5, 0.0}) {
      worst = std::min(worst, damping_ratio({.lambda = 3.0,
                                             .reaching_rate = 50.0 / 12.0,
                                             .resistance_rate = slope / (2.5 * 0.0128),
                                             .fed_forward_rate = slope / 0.0128,
                                             .input_gain = 0.4,
                                             .servo_time_constant_s = 0.02,
                                             .sample_time_s = 0.01,
                                             .direct_share = share}));
    }
  }
  EXPECT_LT(worst, 0.7);
  EXPECT_NEAR(named(all, "heading damping").value, worst, 1e-9);
  EXPECT_NEAR(named(all, "speed gain").value, 0.01 * 2.0 * 5.0 / 1.2, kRounding);
  // With weaker motors the differential mode has the smaller authority, 4 d (0.5 - g1/4).
  EXPECT_NEAR(
      named(all, "noise gain").limit,
      0.25 * std::min(4.0 * 0.36 * (0.5 - 1.3268 / 4.0), turning_authority_m(context.own(), 1.0)),
      kRounding);
}

/// With a latency of 10 samples, poles that decay in 30 ms have a damping ratio of 0.27. The slowest
/// poles decay in 1 s without oscillation. Faster gains have the same quick poles, but slow ones with
/// a lower damping ratio, which counts.
TEST(Constraints, CountQuickPolesOfALatencyLess) {
  const SampledHeadingLoop slow{.lambda = 0.69,
                                .reaching_rate = 1.36,
                                .resistance_rate = 19.0,
                                .fed_forward_rate = 19.0,
                                .servo_time_constant_s = 0.02,
                                .sample_time_s = 0.02,
                                .direct_share = 1.0,
                                .motor_time_constant_s = 0.02,
                                .command_delay_s = 0.2};
  EXPECT_GT(dominant_damping_ratio(slow), damping_ratio(slow) + 0.05);
  SampledHeadingLoop fast = slow;
  fast.lambda = 12.0;
  fast.reaching_rate = 24.0;
  EXPECT_LT(dominant_damping_ratio(fast), 0.7 * dominant_damping_ratio(slow));
  // Both have the same sign: positive exactly if the loop is stable.
  for (double factor = 0.1; factor < 200.0; factor *= 1.3) {
    SampledHeadingLoop loop = slow;
    loop.lambda *= factor;
    loop.reaching_rate *= factor;
    const double all = damping_ratio(loop);
    EXPECT_EQ(dominant_damping_ratio(loop) > 0.0, all > 0.0) << factor;
    if (all > 0.0) {
      EXPECT_GE(dominant_damping_ratio(loop), all - 1e-6) << factor;
    }
  }
}

/// Poles that do not turn the vehicle do not make quick poles count less: those of a slow observer,
/// of the servo in differential mode and of the motors in steering mode.
TEST(Constraints, CountQuickPolesByTheSlowPolesOfTheHeading) {
  SampledHeadingLoop loop{.lambda = 3.0,
                          .reaching_rate = 6.0,
                          .resistance_rate = 19.0,
                          .fed_forward_rate = 19.0,
                          .servo_time_constant_s = 0.05,
                          .sample_time_s = 0.02,
                          .direct_share = 1.0,
                          .motor_time_constant_s = 0.02,
                          .command_delay_s = 0.1};
  const double alone = dominant_damping_ratio(loop);
  loop.servo_time_constant_s = 2.0;
  EXPECT_NEAR(dominant_damping_ratio(loop), alone, 1e-9);
  // An observer that is this slow hardly changes the other poles. If its pole were the slowest one,
  // the ratio would be at least 0.75: all others decay at 3 1/s or faster.
  loop.observer_radps = 0.2;
  EXPECT_NEAR(dominant_damping_ratio(loop), alone, 0.02);
  loop = {.lambda = 3.0,
          .reaching_rate = 6.0,
          .resistance_rate = 19.0,
          .fed_forward_rate = 19.0,
          .servo_time_constant_s = 0.05,
          .sample_time_s = 0.02,
          .direct_share = 0.0,
          .command_delay_s = 0.1};
  const double steered = dominant_damping_ratio(loop);
  loop.motor_time_constant_s = 2.0;
  EXPECT_NEAR(dominant_damping_ratio(loop), steered, 1e-9);
}

TEST(Constraints, RequireDampingWithLatency) {
  ConstraintContext context = paper_context(ReachingForm::kStrict, 0.8);
  const std::size_t without = constraints_of(kPaperGains, context).size();
  context.latency_s = 0.02;
  const std::vector<ConstraintReport> late = constraints_of(kPaperGains, context);
  ASSERT_EQ(late.size(), without + 2);
  EXPECT_LT(named(late, "late damping").value, 0.7);
  // "delayed damping" is the smallest damping ratio over all modes and rates with twice the latency
  // plus one sample, which is 5 samples.
  double worst = 1.0;
  for (const double rate_degps : {1.0, 5.0, 20.0, 60.0}) {
    const double rate = rate_degps * std::acos(-1.0) / 180.0;
    for (const double share : {1.0, 0.5, 0.0}) {
      worst = std::min(
          worst,
          damping_ratio({.lambda = 3.0,
                         .reaching_rate = 50.0 / 12.0,
                         .resistance_rate = 0.3028 * 0.825 * std::pow(rate, 0.825 - 1.0) / 0.0128,
                         .fed_forward_rate = 0.3028 * 0.825 * std::pow(rate, 0.825 - 1.0) / 0.0128,
                         .servo_time_constant_s = 0.02,
                         .sample_time_s = 0.01,
                         .direct_share = share,
                         .command_delay_s = 0.05}));
    }
  }
  EXPECT_NEAR(named(late, "delayed damping").value, worst, 1e-9);
  EXPECT_EQ(named(late, "delayed damping").limit, 0.05);
  // The constraints also hold for drawn plants: with less resistance than the law compensates,
  // damping is lower.
  Plant<double> slippery = context.plant;
  slippery.yaw.alpha *= 0.8;
  context.draws = {{slippery, context.wheel_force}};
  const std::vector<ConstraintReport> drawn = constraints_of(kPaperGains, context);
  EXPECT_LT(named(drawn, "late damping").value, named(late, "late damping").value);
  EXPECT_LT(named(drawn, "delayed damping").value, named(late, "delayed damping").value);
}

}  // namespace
}  // namespace awmr::testing
