/// The rates of the state with their partial derivatives. Private to identify/.
///
/// The equations are those of model/dynamics.h for left and right wheel forces; here they are
/// differentiated by hand, which takes a tenth of the time of automatic differentiation. A test
/// compares both.
#pragma once

#include <algorithm>
#include <array>

#include "awmr/model/dynamics.h"
#include "awmr/model/parameters.h"
#include "awmr/model/sliding.h"

namespace awmr {

/// g(w) and its partial derivatives at one speed.
struct ResistanceSlopes {
  double value = 0.0;
  double by_speed = 0.0;
  double by_alpha = 0.0;
  double by_beta = 0.0;
  double by_coulomb = 0.0;
  double by_quadratic = 0.0;
};

/// A resistance with the precomputed chord through rest.
class LinearResistance {
 public:
  explicit LinearResistance(const Resistance<double>& law);
  /// With L = ln |w| and the sign of w on everything but by_speed,
  ///
  ///     g = c + alpha e^(beta L) + q w^2,   dg/dw = (alpha beta e^(beta L))/|w| + 2 q |w|
  ///
  /// and below the law's rest_speed the chord: g and its derivatives at rest_speed, times
  /// w/rest_speed. rest_speed depends on the step length and has no derivative.
  ResistanceSlopes operator()(double speed) const;

 private:
  ResistanceSlopes at(double magnitude) const;
  Resistance<double> law_;
  ResistanceSlopes at_rest_speed_;
};

/// A plant with precomputed reciprocals for repeated evaluation of its rates. Its rates exclude
/// Coulomb friction, which add_friction() adds.
struct LinearPlant {
  /// `by_back_emf`: computes the derivatives by k_e even if k_e is 0. `longest_step_s`: of the
  /// Runge-Kutta steps to come; 0: short enough for sway.
  explicit LinearPlant(const Plant<double>& p, bool by_back_emf = false,
                       double longest_step_s = 0.0)
      : plant(without_friction(p)),
        friction(friction_rates(p)),
        surge(plant.surge),
        yaw(plant.yaw),
        per_mass(1.0 / p.mass_norm),
        per_inertia(1.0 / p.inertia_norm),
        per_lag(1.0 / p.steering_time_constant_s),
        sway_pace(std::min(1.0, p.mass_norm / (p.sway_alpha * longest_step_s))),
        has_back_emf(by_back_emf || p.back_emf_s_per_m > 0.0) {}
  Plant<double> plant;
  FrictionRates<double> friction;
  LinearResistance surge;
  LinearResistance yaw;
  double per_mass;
  double per_inertia;
  double per_lag;
  /// Factor on v_dot, <= 1: sway that is faster than the steps reaches the same v within a step.
  double sway_pace;
  bool has_back_emf;
};

/// Forces and steering at one time.
struct HeldCommand {
  SideForces<double> force{};
  double steering_rad = 0.0;
};

/// Partial derivatives of the rates by the state, those that are not 0: `u_psi` would be d u_dot /
/// d psi.
/// Also psi_r = 1.
struct StateSlopes {
  double x_psi, x_u, x_v;
  double y_psi, y_u, y_v;
  double u_u, u_v, u_r, u_steering;
  double v_u, v_v, v_r, v_steering;
  double r_u, r_v, r_r, r_steering;
  double steering_steering;
};

/// Partial derivatives of the rates of u, v, r and of the steering angle by one number.
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
  DrivenSlopes by_force_left;
  DrivenSlopes by_force_right;
  double steering_by_command = 0.0;
};

/// Computes the rates at `s`. `out` must begin as LinearRates{}: entries that are always 0 are not
/// written.
void linear_rates(const LinearPlant& p, const State<double>& s, const HeldCommand& command,
                  LinearRates& out);

/// Adds Coulomb friction: it brakes a moving vehicle; if it holds the vehicle at rest, rate and
/// derivatives are set to 0.
void add_friction(const LinearPlant& p, const Sliding& way, LinearRates& out);

}  // namespace awmr
