/// Rates of change of the state due to wheel forces, back-EMF and the forces of extra_forces.h, for
/// linear_rates(). The wheel forces include the dead zone and the excess e_b or e_r. Private to
/// identify/.
#pragma once

#include "awmr/identify/logs/simulation/linear_rates.h"

namespace awmr {

/// Force of a wheel after its dead zone is subtracted from the command, and its derivatives.
struct WheelForce {
  double value;
  double by_command;    ///< with respect to the command
  double by_dead_zone;  ///< with respect to the dead zone
};

/// Derivatives of the force of a wheel with respect to e_b, e_r (extra_forces.h) and the speed at
/// which the wheel rolls.
struct ByExcess {
  double by_brake = 0.0;
  double by_reverse = 0.0;
  double by_speed = 0.0;
};

/// Forces of a left and a right wheel. They include the dead zone and the excess e_b or e_r.
struct Wheels {
  WheelForce left;
  WheelForce right;
  ByExcess left_excess{};
  ByExcess right_excess{};
};

inline bool is_on(const WheelForce& wheel) { return wheel.value > 0.0 || wheel.value < 0.0; }

Wheels wheels_of(const LinearPlant& plant, const State<double>& s, const SideForces<double>& force);

/// Derivatives of u_dot, v_dot and r_dot with respect to the sum of left and right wheel forces,
/// and of r_dot with respect to their difference, right minus left.
struct ByForces {
  DrivenSlopes sum;
  double difference;

  /// Change of the rates when the left and the right force change by these amounts.
  DrivenSlopes of(double left, double right) const {
    return {.u = (left + right) * sum.u,
            .v = (left + right) * sum.v,
            .r = (left + right) * sum.r + (right - left) * difference};
  }
};

/// Adds the derivatives of the rates of the state with respect to the commands of the wheels, the
/// dead zone, e_b and e_r (extra_forces.h).
void add_wheel_slopes(const LinearPlant& plant, const Wheels& wheels, const ByForces& forces,
                      LinearRates& out);

/// Adds the effect of back-EMF to the rates of the state and to their derivatives. Call it after
/// the wheel forces and the resistance were added. `left_on`, `right_on`: true if the motors of
/// that side are on. `sin_d`, `cos_d`: sine and cosine of the steering angle d_r.
void add_back_emf(const LinearPlant& plant, const State<double>& s, bool left_on, bool right_on,
                  double sin_d, double cos_d, LinearRates& out);

/// Surge resistance at the speed u, without friction at rest, which add_friction() adds.
ResistanceSlopes surge_resistance(const LinearPlant& plant, double u_mps, LinearRates& out);

/// Yaw resistance at the yaw rate r, without friction at rest, which add_friction() adds.
ResistanceSlopes yaw_resistance(const LinearPlant& plant, double r_radps, LinearRates& out);

/// Drag in turns, k |r|^p |u|^q sgn u, over F_max. It has derivatives with respect to the speed u,
/// the yaw rate r and the fitted numbers k, p and q.
struct TurnDrag {
  double value = 0.0;
  double by_speed = 0.0;
  double by_yaw_rate = 0.0;
  double by_size = 0.0;            ///< with respect to k
  double by_exponent = 0.0;        ///< with respect to p
  double by_speed_exponent = 0.0;  ///< with respect to q
};

/// Computes the drag in turns and its derivatives. Near u = 0, a straight line through 0 replaces
/// |u|^q sgn u. The derivatives treat the speed at which this line ends as constant.
TurnDrag turn_drag(const LinearPlant& plant, const State<double>& s);

void add_turn_drag(const TurnDrag& drag, double per_mass, LinearRates& out);

/// Adds the yaw moment M of a side pull to r_dot. Call it before the derivative of r_dot with
/// respect to I'z is computed, because that derivative is -r_dot/I'z with the complete r_dot.
void add_side_pull(const LinearPlant& plant, double u_mps, LinearRates& out);

/// Adds the effect of a centre of gravity that lies x_c ahead of the driven axle (extra_forces.h).
/// Call it after add_yaw().
void add_axle_offset(const LinearPlant& plant, const State<double>& s, LinearRates& out);

void add_slope(const ExtraForces& extra, double psi_rad, LinearRates& out);

}  // namespace awmr
