/// Effects on a simulated run: disturbances, faults, battery, sensors, actuators, observer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "awmr/model/gains_file.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/run_file.h"
#include "awmr/simulate/sensing.h"
#include "simulate/disturbances.h"
#include "simulate/paper_plant.h"
#include "support/paper_vehicle.h"
#include "support/uncertain_model.h"

namespace awmr::testing {
namespace {

Scenario straight(double duration_s = 10.0) {
  Scenario s{.name = "straight",
             .duration_s = duration_s,
             .initial = {},
             .speed_mps = 1.0,
             .guidance = HeadingSteps{{{0.0, 0.0}}}};
  s.initial.u_mps = 1.0;
  return s;
}

awmr::Run run_of(const Scenario& scenario, YawMode mode = YawMode::kCombined,
                 std::uint64_t sample = 0) {
  const Plant<double> plant = paper_plant();
  SimulateOptions options;
  options.sample = sample;
  return simulate(plant, make_controller(plant, paper_vehicle(), kPaperGains), scenario, mode,
                  options);
}

TEST(Disturbances, AConstantYawMomentLeavesTheLawsSteadyError) {
  // Steady heading error e under the yaw moment N, in the boundary layer at rest:
  //   I'z mu lambda e/eps = -N  =>  e = -N eps/(I'z mu lambda)
  Scenario s = straight();
  s.disturbance.yaw = {constant(0.01)};
  const double expected = 0.01 * 12.0 / (0.01212 * 50.0 * 3.0);
  const awmr::Run run = run_of(s, YawMode::kDifferential);
  EXPECT_NEAR(run.rows.back().state.psi_rad, expected, 1e-6);
}

TEST(Disturbances, AStepActsFromItsTimeOn) {
  Scenario s = straight();
  s.disturbance.surge = {constant(0.2, 5.0)};
  const awmr::Run run = run_of(s);
  EXPECT_NEAR(run.rows[499].state.u_mps, 1.0, 1e-9);
  EXPECT_GT(run.rows[600].state.u_mps, 1.01);
}

TEST(Disturbances, ASlopePullsDownhillForEveryHeading) {
  Scenario s = straight();
  s.disturbance.slope = Slope{radians(5.0), radians(-90.0)};
  EXPECT_LT(run_of(s).rows.back().state.y_m, -0.1);  // the vehicle is pushed sideways
  s.guidance = HeadingSteps{{{0.0, radians(-90.0)}}};
  s.initial.psi_rad = radians(-90.0);
  EXPECT_GT(run_of(s).rows.back().state.u_mps, 1.05);  // the vehicle is faster downhill
}

TEST(Disturbances, BandLimitedNoiseHasItsDeviationAndMemory) {
  Scenario s = straight(400.0);
  DisturbanceTerm noise;
  noise.kind = DisturbanceTerm::Kind::kNoise;
  noise.value = 0.1;
  noise.bandwidth_hz = 1.0;
  s.disturbance.sway = {noise};
  const awmr::Run run = run_of(s);
  double square = 0.0, product = 0.0;
  constexpr std::size_t kLag = 10;  // 0.1 s
  for (std::size_t i = 0; i + kLag < run.rows.size(); ++i) {
    const double x = run.rows[i].disturbance.sway;
    square += x * x;
    product += x * run.rows[i + kLag].disturbance.sway;
  }
  const double n = static_cast<double>(run.rows.size() - kLag);
  // Correlation time 1/(2 pi) s: about 400 * pi independent values, so the standard error of the
  // variance is sqrt(2/1257) = 4 %. The bound is four standard errors.
  EXPECT_NEAR(square / n, 0.01, 0.16 * 0.01);
  EXPECT_NEAR(product / square, std::exp(-0.2 * pi<double>()), 0.1);
}

TEST(Disturbances, AreTheSameForTheSameSampleAndOtherForAnother) {
  Scenario s = straight();
  DisturbanceTerm sine;
  sine.kind = DisturbanceTerm::Kind::kSine;
  sine.value = 0.1;
  sine.frequency_hz = 0.5;
  s.disturbance.yaw = {sine};  // its phase is random
  EXPECT_EQ(run_csv(run_of(s, YawMode::kCombined, 3), s),
            run_csv(run_of(s, YawMode::kCombined, 3), s));
  EXPECT_NE(run_csv(run_of(s, YawMode::kCombined, 3), s),
            run_csv(run_of(s, YawMode::kCombined, 4), s));
}

TEST(Wheels, ADeadWheelCostsAQuarterOfTheThrust) {
  // In open loop with equal left and right forces, a failure of both front motors halves the force.
  Scenario s = straight(20.0);
  s.guidance = OpenLoop{1.0, 0.0};
  s.faults = {{.wheels = {Wheel::kFrontLeft, Wheel::kFrontRight}, .window = {}, .share = 0.0}};
  const awmr::Run run = run_of(s, YawMode::kDifferential);
  EXPECT_NEAR(run.rows.back().state.u_mps, std::pow(0.5 / 1.3157, 1.0 / 0.8841), 1e-6);
  s.faults = {{.wheels = {Wheel::kRearLeft}, .window = {}, .share = 0.0}};
  EXPECT_GT(run_of(s, YawMode::kDifferential).rows.back().state.psi_rad, 0.5);  // turns left
}

TEST(Wheels, ASlipperyPatchUnderTheLeftWheelsTurnsLeftOnlyThere) {
  Scenario s = straight(3.0);
  s.guidance = OpenLoop{1.3157, 0.0};
  s.patches = {{.centre_m = {0.0, 5.3}, .radius_m = 5.0, .force_max = 0.1}};
  EXPECT_GT(run_of(s, YawMode::kDifferential).rows.back().state.psi_rad, 0.1);
  s.patches[0].centre_m = {0.0, 50.0};
  EXPECT_EQ(run_of(s, YawMode::kDifferential).rows.back().state.psi_rad, 0.0);
}

/// A wheel on a slippery patch transmits at most the friction of the ground, also if back-EMF
/// brakes it.
TEST(Wheels, OnASlipperyPatchBackEmfBrakesNoMoreThanTheGroundHolds) {
  Scenario s = straight(1.0);
  s.patches = {{.centre_m = {0.0, 0.0}, .radius_m = 5.0, .force_max = 0.1}};
  Plant<double> plant = paper_plant();
  plant.back_emf_s_per_m = 0.5;
  State<double> state{};
  for (const double u : {-1.5, 0.0, 1.5}) {
    for (const double command : {-0.9, -0.05, 0.02, 0.9}) {
      state.u_mps = u;
      const WheelForces<double> arriving = at_the_ground(s, plant, state, 0.0, {command, command});
      const double force = motor_force(arriving.rear_left, 0.5, u);
      const double wanted = motor_force(command, 0.5, u);
      EXPECT_NEAR(force, math::saturate(wanted, 0.1), 1e-15) << u << ' ' << command;
    }
  }
}

TEST(Wheels, PositionsFollowTheHeading) {
  const Plant<double> plant = paper_plant();
  Scenario s;
  State<double> state{};
  state.x_m = 3.0;
  state.y_m = -2.0;
  state.psi_rad = radians(90.0);  // forward is +y, left is -x
  const double l = plant.front_axle_m;
  const double d = plant.half_track_m;
  const Position<double> places[] = {
      {3.0 - d, -2.0 + l}, {3.0 + d, -2.0 + l}, {3.0 - d, -2.0 - l}, {3.0 + d, -2.0 - l}};
  for (int slips = 0; slips < 4; ++slips) {
    s.patches = {{.centre_m = places[slips], .radius_m = 0.1, .force_max = 0.2}};
    const WheelForces<double> w = at_the_ground(s, plant, state, 0.0, {0.5, 0.6});
    const double forces[] = {w.front_left, w.front_right, w.rear_left, w.rear_right};
    for (int i = 0; i < 4; ++i) EXPECT_EQ(forces[i], i == slips ? 0.2 : i % 2 == 0 ? 0.5 : 0.6);
  }
}

TEST(Wheels, ASlipperyPatchLimitsTheForceOfAMotorWithADeadZoneAndNotItsCommand) {
  Plant<double> plant = paper_plant();
  plant.wheel_dead_zone = 0.1;
  Scenario s;
  s.patches = {{.centre_m = {0.0, 0.0}, .radius_m = 5.0, .force_max = 0.2}};
  const WheelForces<double> wheels = at_the_ground(s, plant, {}, 0.0, {0.25, -0.9});
  EXPECT_EQ(wheels.front_left, 0.25);  // of which 0.15 reach the ground
  EXPECT_NEAR(beyond_dead_zone(wheels.front_right, 0.1), -0.2, 1e-15);
  EXPECT_NEAR(beyond_dead_zone(wheels.rear_right, 0.1), -0.2, 1e-15);
}

TEST(Battery, SpeedFallsToThatOfTheReducedForce) {
  Scenario s = straight(60.0);
  s.battery = Battery{.from_s = 5.0, .to_s = 20.0, .share_end = 0.2};
  const awmr::Run run = run_of(s, YawMode::kDifferential);
  EXPECT_NEAR(run.rows[400].state.u_mps, 1.0, 1e-9);
  EXPECT_NEAR(run.rows.back().state.u_mps, std::pow(0.8 / 1.3157, 1.0 / 0.8841), 1e-6);
}

TEST(Battery, SagsUnderTheMotorsCurrent) {
  // Straight ahead, without back-EMF, and with the command F' at all four wheels, the voltage falls
  // to the fraction s = 1/(1 + 4 rho F'^2), and the force to F' s (rho: `sag`).
  Scenario s = straight(60.0);
  s.guidance = OpenLoop{2.0, 0.0};  // F' = 0.5 of each wheel
  s.battery = Battery{.sag = 0.1};
  const awmr::Run run = run_of(s, YawMode::kDifferential);
  const double force = 0.5 / (1.0 + 4.0 * 0.1 * 0.25);
  EXPECT_NEAR(run.rows.back().state.u_mps, std::pow(4.0 * force / 1.3157, 1.0 / 0.8841), 1e-6);
}

TEST(Battery, SagIsTheVoltageThatTheCurrentsLeave) {
  // Expected value by Kirchhoff's law, solved by iteration: two sides with different speeds and two
  // motors each.
  const SideForces<double> command{0.8, -0.3};
  State<double> at{};
  at.u_mps = 1.2;
  at.r_radps = 0.7;
  constexpr double kSag = 0.15, kBackEmf = 0.2, kHalfTrack_m = 0.25;
  const double wheel_mps[2] = {1.2 - 0.7 * kHalfTrack_m, 1.2 + 0.7 * kHalfTrack_m};
  double voltage = 1.0;
  for (int i = 0; i < 200; ++i) {
    double drawn = 0.0;  // battery current over the stall current of one motor
    for (const auto& [c, w] :
         {std::pair(command.left, wheel_mps[0]), std::pair(command.right, wheel_mps[1])}) {
      drawn += 2.0 * c * (voltage * c - kBackEmf * w);
    }
    voltage = 1.0 - kSag * drawn;
  }
  const SideForces<double> left = under_sag(kSag, 2.0, kBackEmf, kHalfTrack_m, at, command);
  EXPECT_NEAR(left.left, voltage * command.left, 1e-12);
  EXPECT_NEAR(left.right, voltage * command.right, 1e-12);
  const SideForces<double> none = under_sag(0.0, 2.0, kBackEmf, kHalfTrack_m, at, command);
  EXPECT_EQ(none.left, command.left);
}

TEST(SensorChannels, HaveTheirNoiseBiasAndSteps) {
  Scenario s = straight(100.0);
  s.guidance = OpenLoop{1.0, 0.0};
  Sensors sensors;
  sensors.heading = {.noise = 0.02, .bias = 0.1, .quantum = 0.0};
  sensors.yaw_rate = {.noise = 0.0, .bias = 0.26, .quantum = 0.5};
  sensors.sway_measured = false;
  s.sensors = sensors;
  const awmr::Run run = run_of(s);
  double sum = 0.0, square = 0.0;
  for (const RunRow& row : run.rows) {
    sum += row.measured.psi_rad - row.state.psi_rad;
    square += std::pow(row.measured.psi_rad - row.state.psi_rad - 0.1, 2);
    EXPECT_EQ(row.measured.r_radps, 0.5);  // bias 0.26, rounded to the quantum 0.5
    EXPECT_EQ(row.measured.u_mps, row.state.u_mps);
  }
  const double n = static_cast<double>(run.rows.size());
  EXPECT_NEAR(sum / n, 0.1, 4.0 * 0.02 / 100.0);          // 10^4 readings: s.e. 0.02/100
  EXPECT_NEAR(std::sqrt(square / n), 0.02, 0.03 * 0.02);  // s.e. 1/sqrt(2 10^4) = 0.7 %
}

/// Largest distance of the measured from the true position between two times, m.
double largest_error_m(const awmr::Run& run, double from_s, double to_s) {
  double largest = 0.0;
  for (const RunRow& row : run.rows) {
    if (row.t_s < from_s || row.t_s > to_s) continue;
    largest =
        std::max(largest, distance_m(row.measured_position_m, {row.state.x_m, row.state.y_m}));
  }
  return largest;
}

Scenario with_gps(double latency_s, std::vector<Window> dropouts) {
  Scenario s = straight(60.0);
  s.guidance = HeadingSteps{{{0.0, 0.0}, {20.0, radians(90.0)}}};
  Gps gps;
  gps.rate_hz = 5.0;
  gps.latency_s = latency_s;
  gps.dropouts = std::move(dropouts);
  Sensors sensors;
  sensors.speed.bias = 0.1;  // error of dead reckoning, 0.1 m per second
  sensors.gps = gps;
  s.sensors = sensors;
  return s;
}

TEST(GpsReceiver, BetweenFixesAndForItsLatencyThePositionIsCarriedOn) {
  // Dead reckoning runs for at most 0.2 s + latency and 0.17 s until a correction is complete, and
  // drifts by 0.1 m/s. The motion held over three samples adds less than 0.02 m where speed or
  // heading changes.
  EXPECT_LT(largest_error_m(run_of(with_gps(0.0, {})), 1.0, 60.0), 0.1 * 0.37 + 0.02);
  EXPECT_LT(largest_error_m(run_of(with_gps(0.5, {})), 1.0, 60.0), 0.1 * 0.87 + 0.02);
  EXPECT_GT(largest_error_m(run_of(with_gps(0.5, {})), 1.0, 60.0), 0.1 * 0.5);
}

/// At 1 m/s the held position is off by up to 0.69 m: the last fix is up to 0.19 s + 0.5 s of
/// latency old.
TEST(GpsReceiver, WithoutAnEstimateTheLastFixIsHeld) {
  Scenario s = with_gps(0.5, {});
  s.sensors->speed.bias = 0.0;
  s.estimator = PositionMethod::kNone;
  EXPECT_NEAR(largest_error_m(run_of(s), 1.0, 60.0), 0.69, 0.01);
}

TEST(GpsReceiver, InADropOutThePositionDriftsAndComesBack) {
  const awmr::Run run = run_of(with_gps(0.0, {{30.0, 45.0}}));
  EXPECT_NEAR(largest_error_m(run, 30.0, 45.0), 1.5, 0.1);
  EXPECT_LT(largest_error_m(run, 45.5, 60.0), 0.05);
}

TEST(ActuatorSteps, CommandsAreMultiplesOfTheirSteps) {
  Scenario s = straight();
  s.guidance = HeadingSteps{{{0.0, radians(30.0)}}};
  s.actuators = Actuators{.steering_quantum_rad = radians(0.4), .pwm_counts = 255};
  for (const RunRow& row : run_of(s).rows) {
    const double steps = row.steering_command_rad / radians(0.4);
    const double counts = row.force.left * 255.0;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_NEAR(counts, std::round(counts), 1e-9);
  }
}

constexpr ObserverGains<double> kObserver{
    .bandwidth_radps = 5.0, .yaw_max_m = 0.3, .surge_max = 0.5};

/// Errors of neighbouring samples have the correlation exp(-T_s/tau) and the given standard
/// deviation.
TEST(SensorChannels, HaveNoiseWithACorrelationTime) {
  Sensors sensors;
  sensors.heading = {.noise = 0.02, .correlation_s = 0.2};
  double squares = 0.0;
  double products = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Sensing sensing(sensors, 0.01, run_seed(seed, 1, 0));
    double before = 0.0;
    for (std::size_t k = 0; k < 5000; ++k) {
      const double error = sensing.at(k, {}).motion.psi_rad;
      squares += error * error;
      products += k > 0 ? error * before : 0.0;
      before = error;
      ++count;
    }
  }
  // Tolerance: 100,000 correlated readings determine the deviation like 2,500 independent ones.
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.001);
  EXPECT_NEAR(products / squares, std::exp(-0.01 / 0.2), 0.01);
}

TEST(SensorChannels, ReturnTheValueFromOneLatencyAgo) {
  Sensors sensors;
  sensors.heading.latency_s = 0.03;
  sensors.yaw_rate.latency_s = 0.014;
  sensors.speed.latency_s = 0.001;
  Sensing sensing(sensors, 0.01, run_seed(0, 0, 0));
  for (int k = 0; k < 10; ++k) {
    State<double> truth{};
    truth.psi_rad = k;
    truth.r_radps = 10.0 * k;
    truth.u_mps = 100.0 * k;
    const Sensed sensed = sensing.at(static_cast<std::size_t>(k), truth);
    EXPECT_EQ(sensed.motion.psi_rad, std::max(0, k - 3));
    EXPECT_NEAR(sensed.motion.r_radps, 10.0 * std::max(0.0, k - 1.4), 1e-12);
    EXPECT_NEAR(sensed.motion.u_mps, 100.0 * std::max(0.0, k - 0.1), 1e-10);
  }
}

TEST(Motors, TheForceFollowsItsCommandWithTheirTimeConstant) {
  // The expected u and F, straight ahead under a constant command c, are computed by Heun's method
  // in steps of 10 us:
  //   u_dot = (4 F - g1(u))/m',   F_dot = (c - F)/tau
  Scenario s = straight(0.5);
  s.initial.u_mps = 0.2;
  s.guidance = OpenLoop{1.0, 0.0};
  s.actuators = Actuators{.motor_time_constant_s = 0.08};
  const awmr::Run run = run_of(s, YawMode::kDifferential);
  const Plant<double> plant = paper_plant();
  double u = 0.2;
  double force = 0.0;
  constexpr double kStep_s = 1e-5;
  for (int i = 0; i < 50000; ++i) {
    const auto accel = [&](double at, double f) {
      return (4.0 * f - plant.surge(at)) / plant.mass_norm;
    };
    const double next = force + kStep_s * (0.25 - force) / 0.08;
    const double first = accel(u, force);
    u += 0.5 * kStep_s * (first + accel(u + kStep_s * first, next));
    force = next;
  }
  // Tolerance: the simulator replaces each force by its mean over the sample, with an error of
  // (T_s/tau)^2/24 of the force's change.
  EXPECT_NEAR(run.rows.back().state.u_mps, u, 1e-3 * u);
  EXPECT_LT(run.rows[5].state.u_mps, run_of(
                                         [&] {
                                           Scenario direct = s;
                                           direct.actuators.reset();
                                           return direct;
                                         }(),
                                         YawMode::kDifferential)
                                         .rows[5]
                                         .state.u_mps);
}

TEST(Observer, RemovesTheSteadyErrorOfAConstantDisturbance) {
  Scenario s = straight();
  s.disturbance.yaw = {constant(0.01)};
  s.disturbance.surge = {constant(-0.1)};
  for (const YawMode mode : kYawModes) {
    s.control.observer.reset();
    const State<double> without = run_of(s, mode).rows.back().state;
    s.control.observer = kObserver;
    const State<double> with = run_of(s, mode).rows.back().state;
    EXPECT_GT(std::abs(without.psi_rad), 0.05) << name_of(mode);
    EXPECT_LT(std::abs(with.psi_rad), 1e-4) << name_of(mode);
    EXPECT_GT(std::abs(without.u_mps - 1.0), 0.1) << name_of(mode);
    EXPECT_LT(std::abs(with.u_mps - 1.0), 1e-4) << name_of(mode);
  }
}

TEST(Observer, OfTheGainsWorksAsThatOfTheScenarioWhichComesFirst) {
  Scenario bare = straight();
  bare.disturbance.yaw = {constant(0.01)};
  Scenario own = bare;
  own.control.observer = kObserver;
  Gains<double> tuned = kPaperGains;
  tuned.observer = {5.0, 0.3, 0.5};
  Gains<double> slower = kPaperGains;
  slower.observer = {1.0, 0.3, 0.5};
  const auto rows = [](const Scenario& s, const Gains<double>& gains) {
    const auto c = make_controller(paper_plant(), paper_vehicle(), gains);
    const awmr::Run run =
        simulate(paper_plant(), c, s, YawMode::kCombined, {.sample_time_s = 0.01});
    return run_csv(run, s);
  };
  EXPECT_EQ(rows(bare, tuned), rows(own, kPaperGains));
  EXPECT_EQ(rows(own, slower), rows(own, kPaperGains));
  EXPECT_NE(rows(bare, slower), rows(bare, kPaperGains));
  // The observer of the gains has no effect with an LQI, which has its own integral.
  Scenario lqi = bare;
  lqi.control.lqi = {
      .heading_rad = 0.05, .yaw_rate_radps = 1.0, .integral_rad_s = 0.05, .tau_turn_m = 0.1};
  EXPECT_EQ(rows(lqi, tuned), rows(lqi, kPaperGains));
}

TEST(Observer, RefusesABandwidthTooHighForTheSampleTime) {
  Scenario s = straight();
  s.control.observer = kObserver;
  s.control.observer->bandwidth_radps = 100.0;
  const Model model = fitted_paper_model();
  const auto refused = plant_for(s, model);
  ASSERT_FALSE(refused);
  EXPECT_NE(to_text(refused.error()).find("disturbance_observer/bandwidth_radps"),
            std::string::npos);
  Gains<double> gains = kPaperGains;
  gains.observer = {100.0, 0.1, 0.5};
  EXPECT_FALSE(controller_for(model, gains));
}

double overshoot_deg(bool anti_windup) {
  Scenario s = straight(20.0);
  s.guidance = HeadingSteps{{{0.0, radians(90.0)}}};
  s.control.observer = kObserver;
  s.control.anti_windup = anti_windup;
  const awmr::Run run = run_of(s, YawMode::kSteering);
  const Plant<double> plant = paper_plant();
  return *metrics_of(run, s, make_controller(plant, paper_vehicle(), kPaperGains)).overshoot_deg;
}

TEST(Observer, WithAntiWindupASaturatedTurnIsNotTakenForADisturbance) {
  // Steering is at its stop through most of a 90 deg turn.
  EXPECT_LT(overshoot_deg(true), 2.0);
  EXPECT_GT(overshoot_deg(false), 2.0 * overshoot_deg(true));
}

TEST(World, RefusesAFaultOfWheelsWithoutMotors) {
  Model model = fitted_paper_model();
  Scenario scenario = short_open_loop();
  scenario.faults = {{.wheels = {Wheel::kFrontLeft, Wheel::kRearLeft}, .window = {}},
                     {.wheels = {Wheel::kRearRight}, .window = {}}};
  EXPECT_TRUE(check_scenario(scenario, model));
  model.vehicle.drive = Drive::kFrontWheel;
  const Status refused = check_scenario(scenario, model);
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().faults.size(), 1U);
  EXPECT_EQ(refused.error().faults[0].place, "scenario 'circle':/faults/1/wheel");
}

}  // namespace
}  // namespace awmr::testing
