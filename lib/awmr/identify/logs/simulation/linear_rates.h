/// Rates of change of the vehicle's state and their partial derivatives, for log fits. Private to
/// identify/.
///
/// The equations are those of model/dynamics.h for left and right wheel forces. The derivatives are
/// coded by hand, because automatic differentiation takes ten times as long. A test compares both.
#pragma once

#include <array>

#include "awmr/identify/logs/simulation/extra_forces.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/parameters.h"
#include "awmr/model/sliding.h"

namespace awmr {

/// Resistance g(w) and its partial derivatives at one speed or yaw rate w.
struct ResistanceSlopes {
  double value = 0.0;         ///< g(w)
  double by_speed = 0.0;      ///< dg/dw
  double by_alpha = 0.0;      ///< dg/d alpha
  double by_beta = 0.0;       ///< dg/d beta
  double by_coulomb = 0.0;    ///< dg/dc
  double by_quadratic = 0.0;  ///< dg/dq
};

/// Resistance law with derivatives. Below the law's rest_speed, a straight line from 0 to the value
/// at rest_speed replaces the law. Without this line, integration steps would be unstable near
/// rest, where the law is too steep.
class LinearResistance {
 public:
  explicit LinearResistance(const Resistance<double>& law);
  /// Computes the resistance g at the speed w, and its derivatives with respect to w and to the
  /// parameters alpha, beta, c and q of the law. For w > 0, with L = ln w:
  ///
  ///     g = c + alpha e^(beta L) + q w^2,   dg/dw = (alpha beta e^(beta L))/w + 2 q w
  ///
  /// g(-w) = -g(w). So for w < 0, g and its derivatives with respect to the parameters are those at
  /// |w| with the opposite sign; dg/dw (by_speed) is the same. Below rest_speed, all of them except
  /// dg/dw are the values at rest_speed times w/rest_speed, and dg/dw is g(rest_speed)/rest_speed.
  /// The derivatives treat rest_speed as a constant.
  ResistanceSlopes operator()(double speed) const;

 private:
  ResistanceSlopes at(double magnitude) const;
  Resistance<double> law_;
  ResistanceSlopes at_rest_speed_;
};

/// Vehicle model with precomputed reciprocals, because a fit evaluates its rates very often.
/// linear_rates() leaves out the friction at rest, which add_friction() adds.
struct LinearPlant {
  /// `by_back_emf`: true to compute the derivatives of the rates with respect to the back-EMF k_e
  /// even if k_e is 0. `longest_step_s`: longest Runge-Kutta step that will be used; 0 if all steps
  /// are short compared with the time constant of sway.
  explicit LinearPlant(const Plant<double>& p, bool by_back_emf = false,
                       double longest_step_s = 0.0, const ExtraForces& extra_forces = {});
  Plant<double> plant;
  FrictionRates<double> friction;  ///< decelerations by the friction at rest, Coulomb plus Stribeck
  ExtraForces extra;
  LinearResistance surge;
  LinearResistance yaw;
  double per_mass;
  double per_inertia;
  double per_lag;
  /// Factor on v_dot, <= 1, that keeps the integration stable. If the time constant m'/a_s of sway
  /// (mass over sway resistance) is shorter than a step, the factor is below 1: the sway speed v
  /// then approaches the same steady value with a time constant of one step.
  double sway_pace;
  /// Factor k |r|^p sgn r of the drag in turns, r: yaw rate (extra_forces.h).
  LinearResistance turn_drag_of_yaw;
  double step_per_mass;  ///< longest step / m', m/s: change of the speed by F_max in one step
  bool has_back_emf;
  bool has_surge_stribeck;
  bool has_yaw_stribeck;
  bool has_slope;
  bool has_side_pull;
  bool has_axle_offset;
  bool has_turn_drag;
  bool has_force_excess;  ///< true: e_b or e_r (extra_forces.h) is free or not 0
};

/// Wheel forces and steering command, held constant over a step.
struct HeldCommand {
  SideForces<double> force{};
  double steering_rad = 0.0;
  SideForces<bool> is_off{};  ///< true: the motors of this side have no back-EMF
};

/// Partial derivatives of the rates of the state with respect to the state. The name x_psi means d
/// x_dot / d psi. Other derivatives are 0, except d psi_dot / d r = 1.
struct StateSlopes {
  double x_psi, x_u, x_v;
  double y_psi, y_u, y_v;
  double u_psi, u_u, u_v, u_r, u_steering;
  double v_psi, v_u, v_v, v_r, v_steering;
  double r_u, r_v, r_r, r_steering;
  double steering_steering;
};

/// Partial derivatives of u_dot, v_dot, r_dot and the steering rate with respect to one parameter
/// or force.
struct DrivenSlopes {
  double u = 0.0;
  double v = 0.0;
  double r = 0.0;
  double steering = 0.0;
};

struct LinearRates {
  State<double> rates{};
  StateSlopes by_state{};
  std::array<DrivenSlopes, kParameterCount> by_parameter{};
  std::array<DrivenSlopes, kExtraForceCount> by_extra{};  ///< read only for free forces
  DrivenSlopes by_force_left;
  DrivenSlopes by_force_right;
  double steering_by_command = 0.0;
  /// d steering rate / d rate limit: 1 or -1 at the rate limit of the servo, else 0.
  double steering_by_max_rate = 0.0;
};

/// Sets the rates of the pose at the state `s`, and their derivatives with respect to the state:
///
///     x_dot = u cos psi - v sin psi,   y_dot = u sin psi + v cos psi,   psi_dot = r
void add_kinematics(const State<double>& s, LinearRates& out);

/// Computes the rates of the state at the state `s`, and their derivatives. Before the first call,
/// `out` must be LinearRates{}, because the function does not write derivatives that are always 0.
void linear_rates(const LinearPlant& p, const State<double>& s, const HeldCommand& command,
                  LinearRates& out);

/// Adds the friction at rest to the rates of u and r (u_dot and r_dot). `way`: direction of u and
/// r; 0 for a speed that friction holds at 0. For such a speed, the function sets its rate and the
/// derivatives of this rate to 0.
void add_friction(const LinearPlant& p, const Sliding<double>& way, LinearRates& out);

}  // namespace awmr
