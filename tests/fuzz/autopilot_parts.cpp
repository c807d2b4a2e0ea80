/// Fuzz target: the complete autopilot with any of its optional features in use and with arbitrary
/// input bits, corners and obstacles. Checks that every command is finite and within its limits,
/// that a fault gives the safe command, and that every step terminates.
#include <cmath>
#include <cstring>
#include <iterator>

#include "awmr/control/autopilot.h"
#include "fuzz/target.h"
#include "support/paper_vehicle.h"

using awmr::fuzz::require;

namespace {

using namespace awmr;

constexpr float kSampleTime_s = 0.01F;
constexpr int kMaxPoints = 4;

/// Bits of the first input byte: optional features that the run uses, and whether time stamps and
/// mode are made valid.
enum Use : unsigned {
  kFresh = 1,
  kKnownMode = 2,
  kWaypoints = 4,
  kLine = 8,
  kPath = 16,
  kObstacles = 32,
  kShaping = 64,
  kObserver = 128
};

/// The paper's robot with a dead zone and back-EMF of its motors.
struct Robot {
  ParameterBlock block{};
  RestBlock rest{};
  std::uint32_t crc = 0;

  Robot() {
    const Controller<float> controller = awmr::testing::paper_controller_of<float>();
    block.surge_alpha_beta[0] = controller.surge.alpha;
    block.surge_alpha_beta[1] = controller.surge.beta;
    block.yaw_alpha_beta[0] = controller.yaw.alpha;
    block.yaw_alpha_beta[1] = controller.yaw.beta;
    block.constants = prepared(controller).constants;
    block.safety = {3.0F, 8.0F, 100, 600, 1000, 30};
    rest.dead_zone = 0.05F;
    rest.back_emf_s_per_m = 0.2F;
    crc = crc32_of_parameters(&block, nullptr, 0, nullptr, 0, &rest);
  }
};

/// Reads values from the input bytes in sequence; after the last byte it returns zeros.
class InputBytes {
 public:
  InputBytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  template <class V>
  V next() {
    V value{};
    const std::size_t count = size_ < sizeof value ? size_ : sizeof value;
    if (count > 0) std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

AutopilotInput input_of(InputBytes& bytes) {
  AutopilotInput in{};
  in.mode = bytes.next<std::uint8_t>();
  in.measured = bytes.next<Measurement<float>>();
  in.position_m = bytes.next<Position<float>>();
  in.reference = bytes.next<Reference<float>>();
  in.times = bytes.next<InputTimes>();
  in.position_is_fix = bytes.next<std::uint8_t>() & 1U;
  in.fix_ms = bytes.next<std::uint32_t>();
  return in;
}

void renew(AutopilotInput& in, std::uint32_t now_ms) {
  in.times = {now_ms, now_ms, now_ms, now_ms};
}

using Whole = Autopilot<Resistance<float>, AllParts<>>;

void check(const Whole& autopilot, const Robot& robot, const AutopilotOutput& out) {
  const AllocationConstants<float>& limits = autopilot.controller.constants.allocation;
  const float most = with_dead_zone(limits.force_max, robot.rest.dead_zone);
  const float least = with_dead_zone(limits.force_min, robot.rest.dead_zone);
  const Allocation<float>& command = out.command;
  require(command.force.left >= least && command.force.left <= most,
          "left force within its limits");
  require(command.force.right >= least && command.force.right <= most,
          "right force within its limits");
  require(std::fabs(command.steering_rad) <= limits.steering_max_rad,
          "steering angle within its limits");
  if (out.fault == kFaultNone) return;
  require(command.force.left == 0.0F && command.force.right == 0.0F, "a fault stops the motors");
  require(command.steering_rad == 0.0F, "a fault puts the wheels straight");
}

}  // namespace

/// The input bytes are one byte with the bits of Use, an autopilot input, then corners and
/// obstacles.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Robot kRobot;
  InputBytes bytes(data, size);
  const unsigned use = bytes.next<std::uint8_t>();
  AutopilotInput in = input_of(bytes);
  Position<float> corners[kMaxPoints];
  Obstacle<float> obstacles[2];
  for (Position<float>& corner : corners) corner = bytes.next<Position<float>>();
  for (Obstacle<float>& obstacle : obstacles) obstacle = bytes.next<Obstacle<float>>();
  Sector<float> sectors[2];

  Whole autopilot{};
  require(
      start_autopilot(autopilot, &kRobot.block, nullptr, 0, nullptr, 0, kRobot.crc, &kRobot.rest),
      "the parameters are accepted");
  filter_position(autopilot, position_filter<float>(1.5, 0.2, kSampleTime_s));
  if ((use & kWaypoints) != 0) follow_waypoints(autopilot, {corners, kMaxPoints, 1.0F, true});
  if ((use & kLine) != 0)
    follow_line(autopilot, {corners, kMaxPoints, 0.5F, {1.0F, 2.0F, true}}, 0.01F);
  if ((use & kPath) != 0) follow_path(autopilot, {10.0F, 8.0F, 0.1F, 0.3F}, 0.5F);
  part_of<SlowDown<float>>(autopilot).distance_m = (use & kLine) != 0 ? 2.0F : 0.0F;
  if ((use & kObstacles) != 0) {
    const Avoidance<float> avoidance{2.0F, 1.0F, 0.2F, 0.3F, 0.2F, 0.3F, 0.2F, 1.0F};
    avoid_obstacles(autopilot, avoidance, obstacles, sectors, 2);
  }
  if ((use & kShaping) != 0) shape_headings(autopilot, {4.0F, 0.5F, 2.0F}, kSampleTime_s);
  if ((use & kObserver) != 0) {
    observe_disturbance(autopilot, {{3.0F, 0.2F}, {4.0F, 0.3F}, true}, kSampleTime_s);
  }
  if ((use & kKnownMode) != 0) in.mode = static_cast<std::uint8_t>(in.mode % 3);
  const std::uint32_t first_ms = in.times.now_ms;
  for (std::uint32_t step = 0; step < 3; ++step) {
    if ((use & kFresh) != 0) renew(in, first_ms + 10 * step);
    AutopilotOutput out{};
    autopilot_step(autopilot, in, out);
    check(autopilot, kRobot, out);
    in.times.now_ms += 10;
  }
  return 0;
}
