/// Fuzz target: runs the emitted controller, compiled for this machine, on arbitrary input bits.
/// Checks that every command is finite and within its limits, and that a fault gives the safe
/// command.
#include <cmath>
#include <cstring>

#include "awmr.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

namespace {

bool is_between(float value, float lo, float hi) { return value >= lo && value <= hi; }

/// The step does not check the points to follow, because the sketch provides them. A NaN point
/// makes the outputs of the laws NaN, which the last check of the step detects, so no command is
/// NaN.
void check(const awmr_output& out, bool is_following) {
  require(is_between(out.force_left, AWMR_WHEEL_FORCE_MIN, AWMR_WHEEL_FORCE_MAX),
          "left force within its limits");
  require(is_between(out.force_right, AWMR_WHEEL_FORCE_MIN, AWMR_WHEEL_FORCE_MAX),
          "right force within its limits");
  require(std::fabs(out.steering_rad) <= AWMR_STEERING_MAX_RAD, "steering angle within its limits");
  if (out.fault != AWMR_FAULT_NONE) {
    require(out.force_left == 0.0F && out.force_right == 0.0F && out.steering_rad == 0.0F,
            "a fault gives the safe command");
  }
  if (is_following) return;
  require(std::isfinite(out.tau_speed) && std::isfinite(out.tau_turn_m),
          "the outputs of the laws are finite");
  require(std::isfinite(out.psi_ref_rad), "the heading reference is finite");
  require((out.fault & AWMR_FAULT_OUTPUT) == 0, "the output check finds no fault");
}

/// Makes all time stamps current, so that the result depends on the motion in the input bytes.
void renew(awmr_input& in) { in.now_ms = in.heading_ms = in.speed_ms = in.command_ms; }

/// Starts the controller once, because reading the parameters takes longer than a hundred steps.
/// For each further input, a valid step without points to follow restores the same initial state.
void start_at(uint32_t now_ms) {
  static const bool kIsGood = awmr_init() == AWMR_FAULT_NONE;
  require(kIsGood, "the emitted parameters are accepted");
  awmr_input rest{};
  rest.now_ms = rest.heading_ms = rest.speed_ms = rest.command_ms = now_ms;
  awmr_output out;
  awmr_follow(nullptr, 0, 1.0F);
  awmr_step(&rest, &out);
}

}  // namespace

/// The input bytes are one byte whose bits select how the rest is used, then the memory image of an
/// awmr_input, then points to follow.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const unsigned use = *data++;
  --size;
  awmr_input in{};
  const std::size_t taken = size < sizeof in ? size : sizeof in;
  std::memcpy(&in, data, taken);
  data += taken;
  size -= taken;
  if ((use & 1U) != 0) renew(in);
  if ((use & 2U) != 0) in.mode = static_cast<std::uint8_t>(in.mode % 3);

  start_at(in.now_ms - ((use & 8U) != 0 ? 1000U : 10U));
  awmr_point points[4];
  const std::size_t count = size / sizeof *points < 4 ? size / sizeof *points : 4;
  if (count > 0) std::memcpy(points, data, count * sizeof *points);
  const bool is_following = (use & 4U) != 0 && count > 0;
  if (is_following) awmr_follow(points, static_cast<int16_t>(count), 1.0F);
  awmr_output out;
  for (unsigned step = 0; step < 2; ++step) {
    awmr_step(&in, &out);
    check(out, is_following);
    in.now_ms += 10;
    if ((use & 1U) != 0) in.heading_ms = in.speed_ms = in.command_ms = in.now_ms;
  }
  return 0;
}
