// Complete program for the ATmega2560: awmr_params.h and the simulator's controller, in float.
// Inputs from sensors and outputs to motors are volatile here.
#include "awmr_params.h"
#include "support/control_step.h"

namespace {

volatile float sensors[4];     // psi in rad, u in m/s, v in m/s, r in rad/s
volatile float references[5];  // psi_d and its two derivatives, u_d and its derivative
volatile unsigned char selected_mode;
volatile float actuators[3];  // F'L, F'R, d_r in rad
volatile bool is_limited;

awmr::Controller<float> controller() {
  awmr::Controller<float> c;
  c.surge.alpha = AWMR_SURGE_ALPHA;
  c.surge.beta = AWMR_SURGE_BETA;
  c.yaw.alpha = AWMR_YAW_ALPHA;
  c.yaw.beta = AWMR_YAW_BETA;
  c.mass_norm = AWMR_MASS_NORM;
  c.inertia_norm = AWMR_INERTIA_NORM;
  c.gains.heading.lambda = AWMR_HEADING_LAMBDA;
  c.gains.heading.mu = AWMR_HEADING_MU;
  c.gains.heading.epsilon = AWMR_HEADING_EPSILON;
  c.gains.speed.mu = AWMR_SPEED_MU;
  c.gains.speed.epsilon = AWMR_SPEED_EPSILON;
  c.limits.front_axle_m = AWMR_FRONT_AXLE_M;
  c.limits.half_track_m = AWMR_HALF_TRACK_M;
  c.limits.force_min = AWMR_WHEEL_FORCE_MIN;
  c.limits.force_max = AWMR_WHEEL_FORCE_MAX;
  c.limits.steering_max_rad = AWMR_STEERING_MAX_RAD;
  c.limits.steering_max_tan_half = awmr::tan_half(AWMR_STEERING_MAX_RAD);
  return c;
}

}  // namespace

int main() {
  const awmr::Controller<float> c = controller();
  for (;;) {
    const awmr::Measurement<float> m = {sensors[0], sensors[1], sensors[2], sensors[3]};
    const awmr::Reference<float> ref = {references[0], references[1], references[2], references[3],
                                        references[4]};
    const awmr::YawMode mode = static_cast<awmr::YawMode>(selected_mode);
    const awmr::Allocation<float> a = awmr::control_step(c, mode, m, ref).allocation;
    actuators[0] = a.force.left;
    actuators[1] = a.force.right;
    actuators[2] = a.steering_rad;
    is_limited = a.speed_limited || a.steering_limited || a.force_limited || a.steering_powerless;
  }
}
