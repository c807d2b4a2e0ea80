/// Rates of change by the wheel forces, with dead zone and excess, and by the forces of
/// extra_forces.h, for linear_rates(). Private to identify/.
#pragma once

#include "awmr/identify/logs/linear_rates.h"

namespace awmr {

/// Force of a wheel beyond its dead zone, with derivatives.
struct WheelForce {
  double value;
  double by_command;
  double by_dead_zone;
};

/// Derivatives of the force of a wheel by e_b, e_r (extra_forces.h) and the rolling speed.
struct ByExcess {
  double by_brake = 0.0;
  double by_reverse = 0.0;
  double by_speed = 0.0;
};

/// Forces of a left and a right wheel, with dead zone and excess.
struct Wheels {
  WheelForce left;
  WheelForce right;
  ByExcess left_excess{};
  ByExcess right_excess{};
};

/// True if the motor of a wheel is on.
inline bool is_on(const WheelForce& wheel) { return wheel.value > 0.0 || wheel.value < 0.0; }

/// The wheel forces at the commands `force` (extra_forces.h).
Wheels wheels_of(const LinearPlant& plant, const State<double>& s, const SideForces<double>& force);

/// Derivatives of u_dot, v_dot and r_dot by the sum of the forces, and of r_dot by their
/// difference, right minus left.
struct ByForces {
  DrivenSlopes sum;
  double difference;

  /// Change of the rates by changes of the left and the right force.
  DrivenSlopes of(double left, double right) const {
    return {.u = (left + right) * sum.u,
            .v = (left + right) * sum.v,
            .r = (left + right) * sum.r + (right - left) * difference};
  }
};

/// Adds the derivatives by the wheel forces: by the commands, the dead zone and the excess.
void add_wheel_slopes(const LinearPlant& plant, const Wheels& wheels, const ByForces& forces,
                      LinearRates& out);

/// Surge resistance at the speed u without friction at rest (add_friction()).
ResistanceSlopes surge_resistance(const LinearPlant& plant, double u_mps, LinearRates& out);

/// Yaw resistance at the yaw rate r without friction at rest (add_friction()).
ResistanceSlopes yaw_resistance(const LinearPlant& plant, double r_radps, LinearRates& out);

/// Drag in turns, k |r|^p |u|^q sgn u, over F_max, with its derivatives.
struct TurnDrag {
  double value = 0.0;
  double by_speed = 0.0;
  double by_yaw_rate = 0.0;
  double by_size = 0.0;            ///< by k
  double by_exponent = 0.0;        ///< by p
  double by_speed_exponent = 0.0;  ///< by q
};

/// Below a small speed, |u|^q sgn u is replaced by a straight line, whose length counts as constant
/// in the derivatives.
TurnDrag turn_drag(const LinearPlant& plant, const State<double>& s);

/// Adds the derivatives of u_dot by the parameters of the drag in turns.
void add_turn_drag(const TurnDrag& drag, double per_mass, LinearRates& out);

/// Adds the acceleration by the slope of the ground.
void add_slope(const ExtraForces& extra, double psi_rad, LinearRates& out);

}  // namespace awmr
