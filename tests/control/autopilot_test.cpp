/// Guidance in a complete autopilot step, compared with the guidance functions called one by one.
#include "awmr/control/autopilot.h"

#include <cmath>
#include <limits>
#include <vector>

#include "paper_autopilot.h"

namespace awmr::testing::autopilot_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kSampleTime_s = 0.03F;
const YawSplit<float> kCombinedSplit =
    yaw_split<float>(YawMode::kCombined, CombinedSplit::kRedistribute);

/// Avoidance parameters with which the obstacles of these tests change the heading.
constexpr Avoidance<float> kAvoidance{.mmd_base_m = 2.0F,
                                      .mmd_per_speed_s = 1.0F,
                                      .sigma_rad = 0.2F,
                                      .vehicle_radius_m = 0.3F,
                                      .clearance_m = 0.2F,
                                      .hysteresis_m = 0.3F,
                                      .side_hysteresis_rad = 0.2F,
                                      .brake_m = 1.0F};

class AutopilotLeads : public PaperAutopilot {
 protected:
  using Whole = Autopilot<Resistance<float>, AllParts<>>;

  AutopilotLeads() { start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc_); }

  /// Executes the next step at a position and returns its output.
  AutopilotOutput step_at(const Position<float>& position_m) {
    in_.position_m = position_m;
    const std::uint32_t now_ms = in_.times.now_ms + 30;
    in_.times = {now_ms, now_ms, now_ms, now_ms};
    AutopilotOutput out{};
    autopilot_step(autopilot_, in_, out);
    EXPECT_EQ(out.fault, kFaultNone);
    return out;
  }
  /// Expects the output that the control laws alone give for a reference, without any optional
  /// part.
  void expect_reference(const AutopilotOutput& out, const Reference<float>& ref) const {
    EXPECT_EQ(out.psi_ref_rad, ref.psi_rad);
    EXPECT_EQ(out.tau_speed, speed_law(autopilot_.controller, in_.measured, ref));
    EXPECT_EQ(out.tau_turn_m, heading_law(autopilot_.controller, in_.measured, ref));
  }
  Reference<float> led_to(float psi_rad, float speed_share = 1.0F) const {
    return {psi_rad, 0.0F, 0.0F, in_.reference.speed_mps * speed_share, in_.reference.accel_mps2};
  }
  /// Returns the fault of a first step whose position is NaN.
  std::uint8_t fault_without_position() {
    AutopilotInput in = good();
    in.position_m.x_m = kNaN;
    AutopilotOutput out{};
    autopilot_.has_stepped = false;
    autopilot_step(autopilot_, in, out);
    return out.fault;
  }

  Whole autopilot_{};
  AutopilotInput in_ = good();
};

/// Positions of a vehicle that drives from the origin past (5, 5) to (10, 0) and beyond, m.
std::vector<Position<float>> drive() {
  std::vector<Position<float>> places;
  for (int i = 0; i <= 50; ++i) {
    const float x = 0.22F * static_cast<float>(i);
    places.push_back({x, x < 5.0F ? 0.9F * x : 0.95F * (10.0F - x)});
  }
  return places;
}

TEST_F(AutopilotLeads, ByWaypointsUntilTheLastIsReached) {
  const Waypoints<float> waypoints{kPoints, 2, 3.0F, false};
  follow_waypoints(autopilot_, waypoints);
  in_.reference.psi_rate_radps = 0.4F;  // must be ignored: the heading comes from the guidance
  in_.reference.psi_accel_radps2 = 0.5F;
  auto progress = start_waypoints(Position<float>{0.0F, 0.0F}, in_.measured.psi_rad);
  bool has_arrived = false;
  for (const Position<float>& place : drive()) {
    const AutopilotOutput out = step_at(place);
    const auto guided = guide(waypoints, place, progress);
    expect_reference(out, led_to(guided.psi_rad));
    EXPECT_EQ(out.arrived, guided.finished);
    has_arrived = has_arrived || out.arrived;
  }
  EXPECT_TRUE(has_arrived);
}

TEST_F(AutopilotLeads, SlowerOnTheLastLegAlone) {
  const Waypoints<float> waypoints{kPoints, 2, 0.8F, false};
  follow_waypoints(autopilot_, waypoints);
  part_of<SlowDown<float>>(autopilot_).distance_m = 4.0F;
  auto progress = start_waypoints(Position<float>{0.0F, 0.0F}, in_.measured.psi_rad);
  int slower = 0;
  for (const Position<float>& place : drive()) {
    const AutopilotOutput out = step_at(place);
    const auto guided = guide(waypoints, place, progress);
    const bool is_last = progress.next >= 1;
    const float share = is_last ? arrival_share(4.0F, distance_m(place, kPoints[1])) : 1.0F;
    expect_reference(out, led_to(guided.psi_rad, share));
    slower += share < 1.0F ? 1 : 0;
  }
  EXPECT_GT(slower, 10);
  EXPECT_LT(slower, 25);
}

TEST_F(AutopilotLeads, AlongALineToItsEnd) {
  const Position<float> corners[] = {{0.0F, 0.0F}, {5.0F, 5.0F}, {10.0F, 0.0F}};
  const Polyline<float, LineOfSight<float>> line{corners, 3, 1.0F, {1.0F, 2.0F, true}};
  follow_waypoints(autopilot_, {kPoints, 2, 3.0F, false});
  follow_line(autopilot_, line, 0.01F);
  part_of<SlowDown<float>>(autopilot_).distance_m = 3.0F;
  auto progress = start_polyline(in_.measured.psi_rad);
  const LineMotion<float> motion{sideslip_rad(in_.measured.u_mps, in_.measured.v_mps),
                                 in_.measured.u_mps, 0.01F};
  bool has_arrived = false, was_slower = false;
  for (const Position<float>& place : drive()) {
    const AutopilotOutput out = step_at(place);
    const auto guided = guide(line, place, motion, progress);
    const float share = progress.segment >= 1 ? arrival_share(3.0F, guided.to_go_m) : 1.0F;
    expect_reference(out, led_to(guided.psi_rad, share));
    EXPECT_EQ(out.arrived, guided.finished);
    has_arrived = has_arrived || out.arrived;
    was_slower = was_slower || share < 1.0F;
  }
  EXPECT_TRUE(has_arrived && was_slower);
}

TEST_F(AutopilotLeads, AlongAPathFromTheFirstStepOn) {
  const Lissajous<float> path{10.0F, 8.0F, 0.1F, 0.3F};
  const float sideslip = sideslip_rad(in_.measured.u_mps, in_.measured.v_mps);
  for (const float gain_per_s : {0.0F, 0.5F}) {
    for (const float speed_mps : {0.0F, 1.2F}) {
      follow_path(autopilot_, path, gain_per_s);
      in_.reference.speed_mps = speed_mps;
      float held_rad = in_.measured.psi_rad;
      for (int i = 0; i < 40; ++i) {
        const Position<float> place{9.0F - 0.1F * static_cast<float>(i), 0.5F};
        const AutopilotOutput out = step_at(place);
        const auto point = path.at(0.001F * static_cast<float>(30 * i));
        const auto guided = gain_per_s > 0.0F
                                ? closed_path(point, gain_per_s, place, sideslip, held_rad)
                                : open_path(point, held_rad);
        held_rad = guided.psi_rad;
        expect_reference(out, {guided.psi_rad, guided.psi_rate_radps, 0.0F,
                               speed_mps > 0.0F ? speed_mps : guided.speed_mps, 0.0F});
        EXPECT_FALSE(out.arrived);
      }
    }
  }
}

TEST_F(AutopilotLeads, PastObstaclesThatAreNotBehindTheGoal) {
  const Obstacle<float> obstacles[] = {{{3.0F, 2.9F}, 0.5F}, {{11.5F, -0.5F}, 0.4F}};
  Sector<float> sectors[2], expected_sectors[2];
  const Waypoints<float> waypoints{kPoints, 2, 0.8F, false};
  for (const bool has_goal : {true, false}) {
    follow_waypoints(autopilot_, has_goal ? waypoints : Waypoints<float>{nullptr, 0, 0.0F, false});
    avoid_obstacles(autopilot_, kAvoidance, obstacles, sectors, 2);
    in_.reference.psi_rad = -0.7F;
    in_.reference.psi_rate_radps = 0.2F;
    auto progress = start_waypoints(Position<float>{0.0F, 0.0F}, in_.measured.psi_rad);
    AvoidanceState state;
    int turned = 0;
    for (const Position<float>& place : drive()) {
      if (distance_m(place, obstacles[0].centre_m) < 0.9F) continue;
      const AutopilotOutput out = step_at(place);
      const auto guided = guide(waypoints, place, progress);
      Reference<float> ref = has_goal ? led_to(guided.psi_rad) : in_.reference;
      const int target = guided.finished ? 1 : progress.next;
      const float target_m = has_goal ? distance_m(place, kPoints[target]) : 1e30F;
      const auto avoided =
          avoid(kAvoidance, obstacles, expected_sectors, 2, place, in_.measured.psi_rad,
                in_.measured.u_mps, ref.psi_rad, target_m, state);
      ref.speed_mps *= avoided.speed_share;
      if (avoided.active) {
        ref.psi_rad = avoided.psi_rad;
        ref.psi_rate_radps = 0.0F;
        ++turned;
      }
      expect_reference(out, ref);
    }
    EXPECT_GT(turned, 2);
    EXPECT_LT(turned, 48);
  }
}

TEST_F(AutopilotLeads, PastAPointThatAnObstacleCovers) {
  const Obstacle<float> obstacles[] = {{kPoints[0], 2.0F}};
  Sector<float> sectors[1];
  follow_waypoints(autopilot_, {kPoints, 2, 0.8F, false});
  avoid_obstacles(autopilot_, kAvoidance, obstacles, sectors, 1);
  EXPECT_NEAR(step_at({0.0F, -9.0F}).psi_ref_rad, std::atan2(9.0F, 10.0F), 1e-4F);
}

TEST_F(AutopilotLeads, WithAShapedHeadingThatRestartsAfterAFault) {
  const HeadingShaping<float> filter{4.0F, 0.5F, 2.0F};
  shape_headings(autopilot_, filter, kSampleTime_s);
  in_.measured.psi_rad = 3.0F;
  in_.reference.psi_rad = -2.5F;  // the shorter turn crosses +-pi
  auto state = start_shaping(in_.measured.psi_rad);
  const auto expect_shaped = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      const AutopilotOutput out = step_at({0.0F, 0.0F});
      shape(filter, -2.5F, kSampleTime_s, state);
      state.psi_rad = called_wrap_angle(state.psi_rad);
      expect_reference(out, {state.psi_rad, state.psi_rate_radps, state.psi_accel_radps2,
                             in_.reference.speed_mps, 0.0F});
    }
  };
  expect_shaped(60);
  EXPECT_LT(state.psi_rad, 0.0F);
  AutopilotInput bad = in_;
  bad.mode = 7;
  AutopilotOutput out{};
  autopilot_step(autopilot_, bad, out);
  EXPECT_EQ(out.fault, kFaultRange);
  state = start_shaping(in_.measured.psi_rad);
  expect_shaped(5);
}

TEST_F(AutopilotLeads, LessTheDisturbanceThatTheObserverSees) {
  const Observers<float> observers{{3.0F, 0.2F}, {4.0F, 0.3F}, true};
  observe_disturbance(autopilot_, observers, kSampleTime_s);
  const auto& c = autopilot_.controller;
  const ControlConstants<float>& k = c.constants;
  ObserversState<float> state{};
  for (int i = 0; i < 40; ++i) {
    in_.measured.u_mps = 1.0F + 0.01F * static_cast<float>(i);
    in_.measured.r_radps = 0.2F - 0.02F * static_cast<float>(i);
    const Measurement<float>& m = in_.measured;
    const AutopilotOutput out = step_at({0.0F, 0.0F});
    const ObservedMotion<float> motion{{k.mass_norm * m.u_mps, k.inertia_norm * m.r_radps},
                                       {c.surge(m.u_mps), c.yaw(m.r_radps)},
                                       k.mass_norm * m.r_radps * m.v_mps};
    if (i == 0) state = start_observers(observers, motion.momentum);
    const AxisForces<float> seen = estimate(observers, motion, state);
    const float tau_speed = speed_law(c, m, in_.reference) - seen.surge;
    const float tau_turn_m = heading_law(c, m, in_.reference) - seen.yaw_m;
    EXPECT_EQ(out.tau_speed, tau_speed);
    EXPECT_EQ(out.tau_turn_m, tau_turn_m);
    Allocation<float> command{};
    allocate(kFourWheelSteering, kCombinedSplit, tau_speed, tau_turn_m, k.allocation, command);
    EXPECT_EQ(out.command.force.left, command.force.left);
    EXPECT_EQ(out.command.steering_rad, command.steering_rad);
    const auto allocated = generalised_forces(k.allocation.front_axle_m, k.allocation.half_track_m,
                                              command.force, command.steering_rad);
    advance(observers, seen, {tau_speed, tau_turn_m}, allocated, motion, kSampleTime_s, state);
    if (i > 0) {
      EXPECT_NE(seen.surge, 0.0F);
    }
  }
}

TEST_F(AutopilotLeads, AnObserverTunedWithTheGainsIsOnFromTheStart) {
  const ObserverBlock tuned{3.0F, 0.2F, 0.3F, kSampleTime_s};
  const std::uint32_t crc = crc32_of_parameters(&block_, nullptr, 0, nullptr, 0, nullptr, &tuned);
  decltype(autopilot_) other{};
  ASSERT_TRUE(start_autopilot(other, &block_, nullptr, 0, nullptr, 0, crc, nullptr, &tuned));
  observe_disturbance(autopilot_, Observers<float>{{3.0F, 0.2F}, {3.0F, 0.3F}, true},
                      kSampleTime_s);
  AutopilotOutput by_gains{};
  for (int i = 0; i < 40; ++i) {
    in_.measured.r_radps = 0.2F - 0.02F * static_cast<float>(i);
    const AutopilotOutput by_call = step_at({0.0F, 0.0F});
    autopilot_step(other, in_, by_gains);
    EXPECT_EQ(by_gains.tau_turn_m, by_call.tau_turn_m);
    EXPECT_EQ(by_gains.command.force.left, by_call.command.force.left);
  }
  EXPECT_FALSE(start_autopilot(other, &block_, nullptr, 0, nullptr, 0, crc_, nullptr, &tuned))
      << "the check sum must cover the observer";
}

TEST_F(AutopilotLeads, WithTheGainsOfTheMode) {
  ModeGainsBlock by_mode{};
  for (int mode = 0; mode < kYawModeCount; ++mode) {
    const float f = 0.5F + 0.25F * static_cast<float>(mode);
    const LawConstants<float>& c = block_.constants.laws;
    const bool is_observed = mode == 1;
    by_mode.in[mode] = {{f * c.lambda, f * c.heading_rate, f * c.heading_slope, f * c.heading_limit,
                         f * c.speed_slope, f * c.speed_limit},
                        is_observed ? 3.0F : 0.0F,
                        is_observed ? 0.2F : 0.0F,
                        is_observed ? 0.3F : 0.0F};
  }
  by_mode.observer_sample_time_s = kSampleTime_s;
  const std::uint32_t crc =
      crc32_of_parameters(&block_, nullptr, 0, nullptr, 0, nullptr, nullptr, &by_mode);
  ASSERT_TRUE(start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc, nullptr, nullptr,
                              &by_mode));
  for (const int mode : {2, 0, 1, 1, 0, 2}) {
    ParameterBlock own = block_;
    own.constants.laws = by_mode.in[mode].laws;
    const ObserverBlock observer{3.0F, 0.2F, 0.3F, kSampleTime_s};
    const ObserverBlock* const tuned = mode == 1 ? &observer : nullptr;
    decltype(autopilot_) other{};
    ASSERT_TRUE(start_autopilot(other, &own, nullptr, 0, nullptr, 0,
                                crc32_of_parameters(&own, nullptr, 0, nullptr, 0, nullptr, tuned),
                                nullptr, tuned));
    in_.mode = static_cast<std::uint8_t>(mode);
    for (int i = 0; i < 5; ++i) {
      in_.measured.r_radps = 0.2F - 0.04F * static_cast<float>(i);
      const AutopilotOutput out = step_at({0.0F, 0.0F});
      AutopilotOutput expected{};
      autopilot_step(other, in_, expected);
      EXPECT_EQ(out.tau_turn_m, expected.tau_turn_m) << mode;
      EXPECT_EQ(out.tau_speed, expected.tau_speed) << mode;
      EXPECT_EQ(out.command.steering_rad, expected.command.steering_rad) << mode;
      EXPECT_EQ(out.command.force.left, expected.command.force.left) << mode;
    }
    if (mode == 1) {  // starts anew when the mode is used again
      in_.mode = 0;
      step_at({0.0F, 0.0F});
    }
  }
  EXPECT_FALSE(start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc_, nullptr, nullptr,
                               &by_mode))
      << "the check sum must cover the gains of the modes";
}

TEST_F(AutopilotLeads, WithForcesThatMakeUpForADeadZone) {
  RestBlock rest{};
  rest.dead_zone = 0.1F;
  const AutopilotOutput plain = step_at({0.0F, 0.0F});
  const std::uint32_t crc = crc32_of_parameters(&block_, nullptr, 0, nullptr, 0, &rest);
  ASSERT_TRUE(start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc, &rest));
  const AutopilotOutput out = step_at({0.0F, 0.0F});
  EXPECT_EQ(out.command.force.left, with_dead_zone(plain.command.force.left, 0.1F));
  EXPECT_EQ(out.command.force.right, with_dead_zone(plain.command.force.right, 0.1F));
  EXPECT_NE(out.command.force.left, plain.command.force.left);
  EXPECT_FALSE(start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc_, &rest))
      << "the check sum must cover the RestBlock";
}

TEST(MadeUpSpeed, IsLimitedToTheCommandAndTheBoundaryLayer) {
  LawConstants<double> laws{};
  laws.speed_slope = 2.0;
  laws.speed_limit = 0.5;  // boundary layer of 0.25 m/s
  EXPECT_EQ(made_up_speed(laws, 0.5, 1.0), 0.5);
  EXPECT_EQ(made_up_speed(laws, 1.2, 1.0), 1.2);
  EXPECT_EQ(made_up_speed(laws, 5.0, 1.0), 1.25);
  EXPECT_EQ(made_up_speed(laws, 5.0, 0.0), 0.25);
  EXPECT_EQ(made_up_speed(laws, 5.0, -1.0), 0.0);
  EXPECT_EQ(made_up_speed(laws, -0.5, -1.0), -0.5);
  EXPECT_EQ(made_up_speed(laws, -5.0, -1.0), -1.25);
  EXPECT_EQ(made_up_speed(laws, -5.0, 1.0), 0.0);
}

TEST_F(AutopilotLeads, WithDrivesThatMakeUpForBackEmfAndForcesThatItLeaves) {
  RestBlock rest{};
  rest.dead_zone = 0.1F;
  rest.back_emf_s_per_m = 0.2F;
  const std::uint32_t crc = crc32_of_parameters(&block_, nullptr, 0, nullptr, 0, &rest);
  ASSERT_TRUE(start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc, &rest));
  const AllocationConstants<float>& at_rest = block_.constants.allocation;
  for (const float u_mps : {-0.4F, 0.0F, 0.5F, 1.4F}) {
    for (const float r_radps : {-0.8F, 0.0F, 2.0F}) {
      in_.measured.u_mps = u_mps;
      in_.measured.r_radps = r_radps;
      const AutopilotOutput out = step_at({0.0F, 0.0F});
      const LawConstants<float>& laws = block_.constants.laws;
      const float emf_mps = made_up_speed(laws, u_mps, in_.reference.speed_mps);
      Allocation<float> made{};
      allocate(kFourWheelSteering, kCombinedSplit, out.tau_speed, out.tau_turn_m,
               at_speed(at_rest, 0.2F, emf_mps), made);
      const SideForces<float> command =
          motor_commands(made.force, at_rest, 0.1F, 0.2F, emf_mps, r_radps);
      EXPECT_EQ(out.command.force.left, command.left) << u_mps << " " << r_radps;
      EXPECT_EQ(out.command.force.right, command.right) << u_mps << " " << r_radps;
      EXPECT_EQ(out.command.steering_rad, made.steering_rad) << u_mps << " " << r_radps;
      EXPECT_LE(out.command.force.right, at_rest.force_max + 0.1F);
    }
  }
}

TEST_F(AutopilotLeads, NeedingAPositionOnlyIfAPartUsesIt) {
  EXPECT_EQ(fault_without_position(), kFaultNone);
  const Position<float> corners[] = {{0.0F, 0.0F}, {5.0F, 5.0F}};
  follow_line(autopilot_, {corners, 2, 0.0F, {1.0F, 1.0F, false}}, 0.01F);
  EXPECT_EQ(fault_without_position(), kFaultNotFinite);
  follow_path(autopilot_, {10.0F, 10.0F, 0.1F, 0.3F}, 0.0F);
  EXPECT_EQ(fault_without_position(), kFaultNone) << "a path without feedback needs no position";
  follow_path(autopilot_, {10.0F, 10.0F, 0.1F, 0.3F}, 0.5F);
  EXPECT_EQ(fault_without_position(), kFaultNotFinite);
  follow_waypoints(autopilot_, {nullptr, 0, 0.0F, false});
  EXPECT_EQ(fault_without_position(), kFaultNone);
  const Obstacle<float> obstacles[] = {{{50.0F, 0.0F}, 1.0F}};
  Sector<float> sectors[1];
  avoid_obstacles(autopilot_, kAvoidance, obstacles, sectors, 1);
  EXPECT_EQ(fault_without_position(), kFaultNotFinite);
  avoid_obstacles(autopilot_, kAvoidance, obstacles, sectors, 0);
  EXPECT_EQ(fault_without_position(), kFaultNone);
}

TEST_F(AutopilotLeads, ByNoPartAfterARestart) {
  const Position<float> corners[] = {{0.0F, 0.0F}, {5.0F, 5.0F}};
  const Obstacle<float> obstacles[] = {{{1.5F, 0.0F}, 0.5F}};
  Sector<float> sectors[1];
  const AutopilotOutput plain = step_at({0.0F, 0.0F});
  const auto start = [this] {
    ASSERT_TRUE(start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc_));
  };
  const auto expect_plain = [&] {
    start();
    const AutopilotOutput out = step_at({0.0F, 0.0F});
    EXPECT_EQ(out.psi_ref_rad, plain.psi_ref_rad);
    EXPECT_EQ(out.tau_speed, plain.tau_speed);
    EXPECT_EQ(out.tau_turn_m, plain.tau_turn_m);
    start();
    EXPECT_EQ(fault_without_position(), kFaultNone);
  };
  follow_line(autopilot_, {corners, 2, 0.0F, {1.0F, 1.0F, false}}, 0.01F);
  expect_plain();
  follow_path(autopilot_, {10.0F, 10.0F, 0.1F, 0.3F}, 0.5F);
  expect_plain();
  avoid_obstacles(autopilot_, kAvoidance, obstacles, sectors, 1);
  expect_plain();
  shape_headings(autopilot_, {4.0F, 0.5F, 2.0F}, kSampleTime_s);
  expect_plain();
  start();
  observe_disturbance(autopilot_, {{3.0F, 0.2F}, {4.0F, 0.3F}, true}, kSampleTime_s);
  step_at({0.0F, 0.0F});
  expect_plain();
}

TEST_F(AutopilotLeads, ByWhatWasRequestedLast) {
  const Position<float> corners[] = {{0.0F, 0.0F}, {0.0F, 5.0F}};
  const auto heading = [this] { return step_at({0.0F, 0.0F}).psi_ref_rad; };
  EXPECT_EQ(heading(), 0.3F);
  follow_waypoints(autopilot_, {kPoints, 2, 0.5F, false});
  EXPECT_NEAR(heading(), std::atan2(5.0F, 5.0F), 1e-4F);
  follow_line(autopilot_, {corners, 2, 0.0F, {1.0F, 1.0F, false}}, 0.01F);
  EXPECT_NEAR(heading(), std::atan2(5.0F, 0.0F), 1e-4F);
  follow_path(autopilot_, {10.0F, 10.0F, 0.0F, 0.3F}, 0.0F);
  EXPECT_NEAR(heading(), std::atan2(3.0F, 0.0F), 1e-4F);
  follow_waypoints(autopilot_, {kPoints + 1, 1, 0.5F, false});
  EXPECT_EQ(heading(), 0.0F);
  follow_waypoints(autopilot_, {nullptr, 0, 0.0F, false});
  EXPECT_EQ(heading(), 0.3F);
}

/// The input has the same fix in each step, and the estimated position moves with speed and
/// heading, also backward.
TEST_F(AutopilotLeads, ByAPositionEstimatedFromTheFixesOfAReceiver) {
  filter_position(autopilot_, position_filter<float>(1.5, 0.2, 0.03));
  follow_waypoints(autopilot_, {kPoints, 1, 0.5F, false});
  in_.measured = {0.0F, 1.0F, 0.0F, 0.0F};
  in_.position_is_fix = 1;
  in_.fix_ms = in_.times.now_ms;
  PositionEstimate<float> estimate(position_filter<float>(1.5, 0.2, 0.03));
  Position<float> at{};
  for (int i = 0; i < 60; ++i) {
    const bool is_new = i == 40;
    const std::uint32_t now_ms = in_.times.now_ms + 30;
    if (is_new) in_.fix_ms = now_ms - 200;
    at = estimate.step({{1.0F, 2.0F}, is_new ? 0.2F : 0.0F, is_new}, in_.measured);
    const AutopilotOutput out = step_at({1.0F, 2.0F});
    EXPECT_EQ(out.psi_ref_rad, math::bearing(5.0F - at.y_m, 5.0F - at.x_m)) << i;
  }
  EXPECT_GT(at.x_m, 1.9F);
  EXPECT_LT(at.x_m, 2.7F);
}

TEST_F(AutopilotLeads, ByAnEstimateThatGoesOnWithoutACommandAndIsStartedAgainWithoutAFix) {
  filter_position(autopilot_, position_filter<float>(1.5, 0.2, 0.03));
  follow_waypoints(autopilot_, {kPoints, 1, 0.5F, false});
  in_.measured = {0.0F, 1.0F, 0.0F, 0.0F};
  in_.position_is_fix = 1;
  step_at({0.0F, 0.0F});
  const auto step_without = [this](std::uint32_t InputTimes::*time) {
    AutopilotOutput out{};
    for (int i = 0; i < 20; ++i) {
      const std::uint32_t now_ms = in_.times.now_ms + 30;
      in_.times = {now_ms, now_ms, now_ms, now_ms};
      in_.times.*time = now_ms - 2000;
      autopilot_step(autopilot_, in_, out);
    }
    return out.fault;
  };
  EXPECT_EQ(step_without(&InputTimes::command_ms), kFaultCommandTimeout);
  // The first of 22 steps starts the estimate at the fix. The other 21 move it by 0.03 m each: 0.63
  // m.
  EXPECT_NEAR(step_at({0.0F, 0.0F}).psi_ref_rad, std::atan2(5.0F, 5.0F - 0.63F), 1e-4F);
  EXPECT_EQ(step_without(&InputTimes::speed_ms), kFaultSpeedStale);
  EXPECT_NEAR(step_at({0.0F, 0.0F}).psi_ref_rad, std::atan2(5.0F, 5.0F), 1e-4F);
}

TEST_F(AutopilotLeads, AFixWithoutTheEstimateIsAFault) {
  Autopilot<Resistance<float>, NoParts> plain{};
  start_autopilot(plain, &block_, nullptr, 0, nullptr, 0, crc_);
  AutopilotInput in = good();
  AutopilotOutput out{};
  autopilot_step(plain, in, out);
  EXPECT_EQ(out.fault, kFaultNone);
  in.position_is_fix = 1;
  autopilot_step(plain, in, out);
  EXPECT_EQ(out.fault, kFaultRange);
}

TEST_F(AutopilotLeads, ANaNHeadingReferenceIsAFaultInEveryMode) {
  static constexpr Position<float> kNowhere[] = {{kNaN, 5.0F}, {10.0F, kNaN}};
  constexpr std::uint8_t kModes[] = {0, 1, 2};
  for (const std::uint8_t mode : kModes) {
    // While braking in steering mode the wheels are straight, whatever the heading reference.
    for (const float speed_mps : {0.0F, 1.5F}) {
      start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc_);
      follow_waypoints(autopilot_, Waypoints<float>{kNowhere, 2, 1.0F, false});
      AutopilotInput in = good();
      in.mode = mode;
      in.reference.speed_mps = speed_mps;
      AutopilotOutput out{};
      autopilot_step(autopilot_, in, out);
      EXPECT_NE(out.fault, kFaultNone) << int{mode} << " " << speed_mps;
      EXPECT_EQ(out.command.force.left, 0.0F);
      EXPECT_EQ(out.command.force.right, 0.0F);
      EXPECT_EQ(out.command.steering_rad, 0.0F);
    }
  }
}

}  // namespace
}  // namespace awmr::testing::autopilot_test
