/// Safety checks of a control step: rejected inputs, their bounds and fault bits.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "paper_autopilot.h"

namespace awmr::testing {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float above(float x) { return std::nextafterf(x, kInfinity); }
float below(float x) { return std::nextafterf(x, -kInfinity); }

/// Allocation with different limits forward and backward, so that a mix-up would be detected.
AllocationConstants<float> constants() {
  AllocationLimits<float> limits = paper_controller_of<float>().limits;
  limits.force_min = -0.5F;
  limits.force_max = 0.75F;
  return prepared(limits);
}

TEST(LastGate, AcceptsValuesUpToTheLimits) {
  const AllocationConstants<float> c = constants();
  struct Command {
    float Allocation<float>::*angle;
    float SideForces<float>::*force;
    float lo, hi;
  };
  const Command commands[] = {
      {nullptr, &SideForces<float>::left, -0.5F, 0.75F},
      {nullptr, &SideForces<float>::right, -0.5F, 0.75F},
      {&Allocation<float>::steering_rad, nullptr, -c.steering_max_rad, c.steering_max_rad}};
  for (const Command& command : commands) {
    const auto passes = [&](float value) {
      Allocation<float> a{};
      (command.angle ? a.*command.angle : a.force.*command.force) = value;
      return is_within_limits(c, a);
    };
    EXPECT_TRUE(passes(command.lo) && passes(command.hi) && passes(0.0F) && passes(-0.0F));
    EXPECT_FALSE(passes(below(command.lo)) || passes(above(command.hi)));
    EXPECT_FALSE(passes(kNaN) || passes(-kNaN) || passes(kInfinity) || passes(-kInfinity));
  }
}

TEST(LastGate, AcceptsLimitsOfOneSign) {
  AllocationConstants<float> c = constants();
  c.force_min = 0.25F;
  const auto passes = [&c](float left) {
    Allocation<float> a{};
    a.force = {left, 0.5F};
    return is_within_limits(c, a);
  };
  EXPECT_TRUE(passes(0.25F));
  EXPECT_FALSE(passes(below(0.25F)) || passes(0.0F) || passes(-0.25F));
}

TEST(Times, AreOldOneMillisecondBeyondTheirLimit) {
  struct Kind {
    std::uint32_t InputTimes::*time;
    std::uint32_t limit_ms;
    std::uint8_t fault;
  };
  for (const Kind& kind : {Kind{&InputTimes::heading_ms, 100, kFaultHeadingStale},
                           Kind{&InputTimes::speed_ms, 600, kFaultSpeedStale},
                           Kind{&InputTimes::command_ms, 1000, kFaultCommandTimeout}}) {
    // At the second time, the clock has just overflowed.
    for (const std::uint32_t now_ms : {5000U, 50U}) {
      const auto fault_at = [&](std::uint32_t age_ms) {
        InputTimes times{now_ms, now_ms, now_ms, now_ms};
        times.*kind.time = now_ms - age_ms;
        return check_times(kLimits, times);
      };
      EXPECT_EQ(fault_at(0), kFaultNone);
      EXPECT_EQ(fault_at(kind.limit_ms), kFaultNone);
      EXPECT_EQ(fault_at(kind.limit_ms + 1), kind.fault);
      EXPECT_EQ(fault_at(0U - 1), kind.fault) << "a time ahead of the clock";
    }
  }
}

class AutopilotFaults : public PaperAutopilot {
 protected:
  /// Output of a first step.
  AutopilotOutput step(const AutopilotInput& in) {
    Autopilot<Resistance<float>, NoParts> autopilot{};
    start_autopilot(autopilot, &block_, nullptr, 0, nullptr, 0, crc_);
    if (points_ > 0) follow_waypoints(autopilot, {kPoints, points_, 0.5F, false});
    AutopilotOutput out{};
    autopilot_step(autopilot, in, out);
    return out;
  }
  void expect_fault(const AutopilotInput& in, unsigned fault, const char* what) {
    const AutopilotOutput out = step(in);
    EXPECT_EQ(out.fault, fault) << what;
    EXPECT_EQ(out.command.force.left, 0.0F);
    EXPECT_EQ(out.command.force.right, 0.0F);
    EXPECT_EQ(out.command.steering_rad, 0.0F);
    EXPECT_EQ(out.tau_speed, 0.0F);
    EXPECT_EQ(out.tau_turn_m, 0.0F);
  }

  int points_ = 0;
};

TEST_F(AutopilotFaults, NoneForAGoodInput) {
  for (const YawMode mode : {YawMode::kDifferential, YawMode::kSteering, YawMode::kCombined}) {
    AutopilotInput in = good();
    in.mode = static_cast<std::uint8_t>(mode);
    EXPECT_EQ(step(in).fault, kFaultNone);
    EXPECT_GT(step(in).tau_speed, 0.0F);
    EXPECT_EQ(step(in).psi_ref_rad, 0.3F);
  }
}

TEST_F(AutopilotFaults, EachMeasurementAndReferenceHasItsRange) {
  struct Value {
    float& value;
    float largest;
  };
  AutopilotInput in = good();
  const Value values[] = {{in.measured.psi_rad, 4096.0F},
                          {in.measured.u_mps, 3.0F},
                          {in.measured.v_mps, 3.0F},
                          {in.measured.r_radps, 8.0F},
                          {in.reference.psi_rad, 4096.0F},
                          {in.reference.psi_rate_radps, 1e6F},
                          {in.reference.psi_accel_radps2, 1e6F},
                          {in.reference.speed_mps, 3.0F},
                          {in.reference.accel_mps2, 1e6F}};
  for (const Value& v : values) {
    for (const float sign : {1.0F, -1.0F}) {
      v.value = sign * v.largest;
      EXPECT_EQ(step(in).fault, kFaultNone) << v.value;
      v.value = sign * above(v.largest);
      expect_fault(in, kFaultRange, "beyond its range");
      v.value = sign * kInfinity;
      expect_fault(in, kFaultNotFinite, "infinite");
      v.value = sign * kNaN;
      expect_fault(in, kFaultNotFinite, "not a number");
    }
    v.value = 0.0F;
  }
}

TEST_F(AutopilotFaults, ThePositionIsCheckedOnlyWhileWaypointsAreFollowed) {
  AutopilotInput in = good();
  for (float Position<float>::*axis : {&Position<float>::x_m, &Position<float>::y_m}) {
    in = good();
    for (const int points : {0, 2}) {
      points_ = points;
      in.position_m.*axis = 1e6F;
      EXPECT_EQ(step(in).fault, kFaultNone);
      in.position_m.*axis = above(1e6F);
      EXPECT_EQ(step(in).fault, points == 0 ? kFaultNone : kFaultRange);
      in.position_m.*axis = kNaN;
      EXPECT_EQ(step(in).fault, points == 0 ? kFaultNone : kFaultNotFinite);
    }
  }
}

TEST_F(AutopilotFaults, AnUnknownModeIsOutOfRange) {
  AutopilotInput in = good();
  in.mode = 3;
  expect_fault(in, kFaultRange, "mode 3");
}

TEST_F(AutopilotFaults, InputsThatWereNotRenewedAreStale) {
  AutopilotInput in = good();
  in.times.heading_ms -= 101;
  expect_fault(in, kFaultHeadingStale, "heading");
  in = good();
  in.times.speed_ms -= 601;
  expect_fault(in, kFaultSpeedStale, "speed");
  in = good();
  in.times.command_ms = in.times.now_ms - 1001;
  expect_fault(in, kFaultCommandTimeout, "command");
}

TEST_F(AutopilotFaults, CombinesSeveralBits) {
  AutopilotInput in = good();
  in.mode = 7;
  in.measured.u_mps = kNaN;
  in.times.speed_ms -= 700;
  expect_fault(in, kFaultRange | kFaultNotFinite | kFaultSpeedStale, "three at once");
}

TEST_F(AutopilotFaults, AStepIsLateAfterItsTimeoutAndTheNextOneIsNot) {
  Autopilot<Resistance<float>, NoParts> autopilot{};
  ASSERT_TRUE(start_autopilot(autopilot, &block_, nullptr, 0, nullptr, 0, crc_));
  AutopilotOutput out{};
  const auto fault_at = [&](std::uint32_t now_ms) {
    AutopilotInput in = good();
    in.times = {now_ms, now_ms, now_ms, now_ms};
    autopilot_step(autopilot, in, out);
    return out.fault;
  };
  EXPECT_EQ(fault_at(1000), kFaultNone);
  EXPECT_EQ(fault_at(1030), kFaultNone);
  EXPECT_EQ(fault_at(1061), kFaultStepLate);
  EXPECT_EQ(fault_at(1091), kFaultNone);
}

TEST_F(AutopilotFaults, TheCheckSumCoversTheLastByteOfEveryTable) {
  ResistanceLine surge[3] = {}, yaw[2] = {};
  RestBlock rest{};
  ObserverBlock observer{};
  const auto crc = [&] { return crc32_of_parameters(&block_, surge, 3, yaw, 2, &rest, &observer); };
  const std::uint32_t undamaged = crc();
  const auto expect_seen = [&](auto& last) {
    auto* bytes = reinterpret_cast<unsigned char*>(&last);
    bytes[sizeof last - 1] ^= 1U;
    EXPECT_NE(crc(), undamaged);
    bytes[sizeof last - 1] ^= 1U;
  };
  expect_seen(block_);
  expect_seen(surge[2]);
  expect_seen(yaw[1]);
  expect_seen(rest);
  expect_seen(observer);
  EXPECT_EQ(crc(), undamaged);
}

TEST_F(AutopilotFaults, DamagedParametersGiveTheSafeCommandForGood) {
  crc_ ^= 1U;
  expect_fault(good(), kFaultParameters, "check sum");
}

TEST_F(AutopilotFaults, ACommandOutsideItsLimitsIsReplacedByTheSafeCommand) {
  // A NaN resistance passes every check of the input.
  block_.surge_alpha_beta[0] = kNaN;
  crc_ = crc32_of_parameters(&block_, nullptr, 0, nullptr, 0);
  expect_fault(good(), kFaultOutput, "the force is NaN");
}

}  // namespace
}  // namespace awmr::testing
