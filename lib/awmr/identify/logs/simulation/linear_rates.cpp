#include "awmr/identify/logs/simulation/linear_rates.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"
#include "awmr/identify/logs/simulation/extra_rates.h"

namespace awmr {
namespace {

/// Adds the rate of the steering angle d_r: d_r_dot = sat((command - d_r)/T, d_rate_max), with the
/// time constant T and the rate limit d_rate_max of the servo. At the rate limit, all derivatives
/// of d_r_dot are 0, except that with respect to d_rate_max.
void add_servo(const LinearPlant& plant, const State<double>& s, double command_rad,
               LinearRates& out) {
  const Plant<double>& p = plant.plant;
  const double target = math::saturate(command_rad, p.steering_max_rad);
  const double wanted = (target - s.steering_rad) * plant.per_lag;
  out.rates.steering_rad = math::saturate(wanted, p.steering_max_rate_radps);
  const double free = std::abs(wanted) <= p.steering_max_rate_radps ? plant.per_lag : 0.0;
  out.by_state.steering_steering = -free;
  out.by_parameter[at(ParameterId::kSteeringTimeConstant)].steering = -wanted * free;
  out.steering_by_max_rate = free > 0.0 ? 0.0 : std::copysign(1.0, wanted);
  out.steering_by_command = std::abs(command_rad) <= p.steering_max_rad ? free : 0.0;
}

/// Adds the derivatives of a rate of the state with respect to the parameters p of its resistance
/// g: -(dg/dp)/inertia.
template <double DrivenSlopes::*kRate>
void add_resistance(const ResistanceSlopes& g, double per_inertia, ParameterId alpha,
                    ParameterId beta, ParameterId coulomb, ParameterId quadratic,
                    LinearRates& out) {
  out.by_parameter[at(alpha)].*kRate = -g.by_alpha * per_inertia;
  out.by_parameter[at(beta)].*kRate = -g.by_beta * per_inertia;
  out.by_parameter[at(coulomb)].*kRate = -g.by_coulomb * per_inertia;
  out.by_parameter[at(quadratic)].*kRate = -g.by_quadratic * per_inertia;
}

Plant<double> with_stribeck(Plant<double> p, const ExtraForces& extra) {
  p.surge.coulomb += extra[ExtraForce::kSurgeStribeck];
  p.yaw.coulomb += extra[ExtraForce::kYawStribeck];
  return p;
}

/// True if the rates depend on the force `one`: its size is not 0, or the fit estimates it or
/// `other`, a second quantity of the same force.
bool has_force(const ExtraForces& extra, ExtraForce one, ExtraForce other) {
  return extra[one] != 0.0 || std::ranges::any_of(extra.columns, [&](const ExtraColumn& column) {
           return column.force == one || column.force == other;
         });
}

/// Returns k |r|^p sgn r, the part of the drag in turns (extra_forces.h) that depends on the yaw
/// rate r, as a resistance law. Below 0.01 rad/s it is proportional to r.
Resistance<double> turn_drag_law(const ExtraForces& extra) {
  constexpr double kRest_radps = 0.01;
  return {.alpha = extra[ExtraForce::kTurnDrag],
          .beta = extra[ExtraForce::kTurnDragExponent],
          .rest_speed = kRest_radps};
}

/// Multiplies v_dot and its derivatives by `pace` (LinearPlant::sway_pace).
void slow_sway(double pace, LinearRates& out) {
  StateSlopes& a = out.by_state;
  for (double* rate : {&out.rates.v_mps, &a.v_psi, &a.v_u, &a.v_v, &a.v_r, &a.v_steering,
                       &out.by_force_left.v, &out.by_force_right.v}) {
    *rate *= pace;
  }
  for (DrivenSlopes& by : out.by_parameter) by.v *= pace;
  for (DrivenSlopes& by : out.by_extra) by.v *= pace;
}

}  // namespace

LinearPlant::LinearPlant(const Plant<double>& p, bool by_back_emf, double longest_step_s,
                         const ExtraForces& extra_forces)
    : plant(without_friction(p)),
      friction(friction_rates(with_stribeck(p, extra_forces))),
      extra(extra_forces),
      surge(plant.surge),
      yaw(plant.yaw),
      per_mass(1.0 / p.mass_norm),
      per_inertia(1.0 / p.inertia_norm),
      per_lag(1.0 / p.steering_time_constant_s),
      sway_pace(std::min(1.0, p.mass_norm / (p.sway_alpha * longest_step_s))),
      turn_drag_of_yaw(turn_drag_law(extra)),
      step_per_mass(longest_step_s * per_mass),
      has_back_emf(by_back_emf || p.back_emf_s_per_m > 0.0),
      has_surge_stribeck(
          has_force(extra, ExtraForce::kSurgeStribeck, ExtraForce::kSurgeStribeckSpeed)),
      has_yaw_stribeck(has_force(extra, ExtraForce::kYawStribeck, ExtraForce::kYawStribeckSpeed)),
      has_slope(has_force(extra, ExtraForce::kSlopeX, ExtraForce::kSlopeY) ||
                has_force(extra, ExtraForce::kSlopeY, ExtraForce::kSlopeX)),
      has_side_pull(has_force(extra, ExtraForce::kSidePull, ExtraForce::kSidePull)),
      has_axle_offset(has_force(extra, ExtraForce::kAxleOffset, ExtraForce::kAxleOffset)),
      has_turn_drag(has_force(extra, ExtraForce::kTurnDrag, ExtraForce::kTurnDragExponent)),
      has_force_excess(has_force(extra, ExtraForce::kBrakeForce, ExtraForce::kReverseForce) ||
                       has_force(extra, ExtraForce::kReverseForce, ExtraForce::kBrakeForce)) {}

LinearResistance::LinearResistance(const Resistance<double>& law) : law_(law) {
  if (law.rest_speed > 0.0) at_rest_speed_ = at(law.rest_speed);
}

ResistanceSlopes LinearResistance::at(double magnitude) const {
  const double log_magnitude = std::log(magnitude);
  const double power = std::exp(law_.beta * log_magnitude);
  const double square = magnitude * magnitude;
  return {.value = law_.coulomb + law_.alpha * power + law_.quadratic * square,
          .by_speed = law_.alpha * law_.beta * power / magnitude + 2.0 * law_.quadratic * magnitude,
          .by_alpha = power,
          .by_beta = law_.alpha * power * log_magnitude,
          .by_coulomb = 1.0,
          .by_quadratic = square};
}

void add_kinematics(const State<double>& s, LinearRates& out) {
  const double c = std::cos(s.psi_rad);
  const double d = std::sin(s.psi_rad);
  out.rates.x_m = s.u_mps * c - s.v_mps * d;
  out.rates.y_m = s.u_mps * d + s.v_mps * c;
  out.rates.psi_rad = s.r_radps;
  out.by_state.x_psi = -out.rates.y_m;
  out.by_state.x_u = c;
  out.by_state.x_v = -d;
  out.by_state.y_psi = out.rates.x_m;
  out.by_state.y_u = d;
  out.by_state.y_v = c;
}

ResistanceSlopes LinearResistance::operator()(double speed) const {
  const double magnitude = std::abs(speed);
  const bool chord = magnitude < law_.rest_speed;
  if (!chord && !(magnitude > 0.0)) return {};
  ResistanceSlopes g = chord ? at_rest_speed_ : at(magnitude);
  const double factor = chord ? speed / law_.rest_speed : std::copysign(1.0, speed);
  if (chord) g.by_speed = g.value / law_.rest_speed;
  g.value *= factor;
  g.by_alpha *= factor;
  g.by_beta *= factor;
  g.by_coulomb *= factor;
  g.by_quadratic *= factor;
  return g;
}

namespace {

/// Sum and difference of the forces of a left and a right wheel, with the direction of steered
/// wheels.
struct SteeredForces {
  double sum;
  double difference;  ///< right minus left
  double sin_d;       ///< sin d_r
  double cos_d;       ///< cos d_r
  double reach;       ///< rho + cos d_r, with rho = 1 if rear wheels are driven, else 0
};

SteeredForces steered_forces(const Wheels& wheels, double rear_driven, double steering_rad) {
  const double cos_d = std::cos(steering_rad);
  return {.sum = wheels.left.value + wheels.right.value,
          .difference = wheels.right.value - wheels.left.value,
          .sin_d = std::sin(steering_rad),
          .cos_d = cos_d,
          .reach = cos_d + rear_driven};
}

/// Adds the rate u_dot of the speed u. `sum`: sum of the left and right wheel forces; d_r: steering
/// angle; rho: 1 if the rear wheels are driven, else 0; g1: surge resistance; D: drag in turns; m':
/// mass.
///
///     u_dot = (sum (rho + cos d_r) - g1(u) - D)/m' + r v
void add_surge(const LinearPlant& plant, const State<double>& s, const SteeredForces& force,
               LinearRates& out) {
  const ResistanceSlopes g1 = surge_resistance(plant, s.u_mps, out);
  const TurnDrag drag = turn_drag(plant, s);
  const double surge = (force.sum * force.reach - g1.value - drag.value) * plant.per_mass;
  out.rates.u_mps = surge + s.r_radps * s.v_mps;
  out.by_state.u_u = -(g1.by_speed + drag.by_speed) * plant.per_mass;
  out.by_state.u_v = s.r_radps;
  out.by_state.u_r = s.v_mps - drag.by_yaw_rate * plant.per_mass;
  out.by_state.u_steering = -force.sum * force.sin_d * plant.per_mass;
  add_resistance<&DrivenSlopes::u>(g1, plant.per_mass, ParameterId::kSurgeAlpha,
                                   ParameterId::kSurgeBeta, ParameterId::kSurgeCoulomb,
                                   ParameterId::kSurgeQuadratic, out);
  out.by_parameter[at(ParameterId::kMassNorm)].u = -surge * plant.per_mass;
  add_turn_drag(drag, plant.per_mass, out);
}

/// Adds the rate of the sway speed v: v_dot = (sum sin d_r - a_s v)/m' - r u. `sum`: sum of the
/// left and right wheel forces; d_r: steering angle; a_s: sway resistance; m': mass.
void add_sway(const LinearPlant& plant, const State<double>& s, const SteeredForces& force,
              LinearRates& out) {
  const double alpha = plant.plant.sway_alpha;
  const double sway = (force.sum * force.sin_d - alpha * s.v_mps) * plant.per_mass;
  out.rates.v_mps = sway - s.r_radps * s.u_mps;
  out.by_state.v_u = -s.r_radps;
  out.by_state.v_v = -alpha * plant.per_mass;
  out.by_state.v_r = -s.u_mps;
  out.by_state.v_steering = force.sum * force.cos_d * plant.per_mass;
  out.by_parameter[at(ParameterId::kSwayAlpha)].v = -s.v_mps * plant.per_mass;
  out.by_parameter[at(ParameterId::kMassNorm)].v = -sway * plant.per_mass;
}

/// Adds the rate r_dot of the yaw rate r. `sum`, `difference`: sum and difference (right minus
/// left) of the wheel forces; l_f: centre of gravity to front axle; d: half of the track width; g3:
/// yaw resistance; M sgn u: side pull (extra_forces.h); I'z: yaw inertia:
///
///     r_dot = (l_f sum sin d_r + d difference (rho + cos d_r) - g3(r) + M sgn u)/I'z
void add_yaw(const LinearPlant& plant, const State<double>& s, const SteeredForces& force,
             LinearRates& out) {
  const Plant<double>& p = plant.plant;
  const ResistanceSlopes g3 = yaw_resistance(plant, s.r_radps, out);
  out.rates.r_radps = (p.front_axle_m * force.sum * force.sin_d +
                       p.half_track_m * force.difference * force.reach - g3.value) *
                      plant.per_inertia;
  out.by_state.r_u = 0.0;
  if (plant.has_side_pull) add_side_pull(plant, s.u_mps, out);
  out.by_state.r_r = -g3.by_speed * plant.per_inertia;
  out.by_state.r_steering =
      (p.front_axle_m * force.sum * force.cos_d - p.half_track_m * force.difference * force.sin_d) *
      plant.per_inertia;
  add_resistance<&DrivenSlopes::r>(g3, plant.per_inertia, ParameterId::kYawAlpha,
                                   ParameterId::kYawBeta, ParameterId::kYawCoulomb,
                                   ParameterId::kYawQuadratic, out);
  out.by_parameter[at(ParameterId::kInertiaNorm)].r = -out.rates.r_radps * plant.per_inertia;
}

}  // namespace

void linear_rates(const LinearPlant& plant, const State<double>& s, const HeldCommand& command,
                  LinearRates& out) {
  const Plant<double>& p = plant.plant;
  const Wheels wheels = wheels_of(plant, s, command.force);
  const SteeredForces force = steered_forces(wheels, p.rear_driven, s.steering_rad);
  add_kinematics(s, out);
  add_servo(plant, s, command.steering_rad, out);
  add_surge(plant, s, force, out);
  add_sway(plant, s, force, out);
  add_yaw(plant, s, force, out);
  if (plant.has_axle_offset) add_axle_offset(plant, s, out);
  add_wheel_slopes(plant, wheels,
                   {{.u = force.reach * plant.per_mass,
                     .v = force.sin_d * plant.per_mass,
                     .r = p.front_axle_m * force.sin_d * plant.per_inertia},
                    p.half_track_m * force.reach * plant.per_inertia},
                   out);
  if (plant.has_back_emf) {
    add_back_emf(plant, s, is_on(wheels.left) && !command.is_off.left,
                 is_on(wheels.right) && !command.is_off.right, force.sin_d, force.cos_d, out);
  }
  if (plant.has_slope) add_slope(plant.extra, s.psi_rad, out);
  if (plant.sway_pace < 1.0) slow_sway(plant.sway_pace, out);
}

namespace {

/// Adds the effect of the friction at rest, c (Coulomb plus Stribeck), to the rate of one speed w
/// (u or r) and to the derivatives of this rate: w_dot -= sgn(w) c/inertia. `way`: sgn(w).
/// `friction`: c/inertia; the inertia is m' for u, I'z for r.
template <double DrivenSlopes::*kRate>
void brake(double way, double friction, double per_inertia, ParameterId coulomb,
           ExtraForce stribeck, ParameterId inertia, double& rate, LinearRates& out) {
  rate -= way * friction;
  out.by_extra[at(stribeck)].*kRate -= way * per_inertia;
  out.by_parameter[at(coulomb)].*kRate = -way * per_inertia;
  out.by_parameter[at(inertia)].*kRate += way * friction * per_inertia;
}

template <double DrivenSlopes::*kRate>
void hold(double& rate, LinearRates& out) {
  rate = 0.0;
  for (DrivenSlopes& by : out.by_parameter) by.*kRate = 0.0;
  for (DrivenSlopes& by : out.by_extra) by.*kRate = 0.0;
  out.by_force_left.*kRate = 0.0;
  out.by_force_right.*kRate = 0.0;
}

}  // namespace

void add_friction(const LinearPlant& p, const Sliding<double>& way, LinearRates& out) {
  StateSlopes& a = out.by_state;
  if (is_held(way.surge, p.friction.surge_mps2)) {
    hold<&DrivenSlopes::u>(out.rates.u_mps, out);
    a.u_psi = a.u_u = a.u_v = a.u_r = a.u_steering = 0.0;
  } else if (p.friction.surge_mps2 > 0.0) {
    const bool is_backward = way.surge < 0.0;
    const double share = is_backward ? 1.0 + p.extra[ExtraForce::kBackwardDrag] : 1.0;
    if (is_backward) out.by_extra[at(ExtraForce::kBackwardDrag)].u += p.friction.surge_mps2;
    brake<&DrivenSlopes::u>(share * way.surge, p.friction.surge_mps2, p.per_mass,
                            ParameterId::kSurgeCoulomb, ExtraForce::kSurgeStribeck,
                            ParameterId::kMassNorm, out.rates.u_mps, out);
  }
  if (is_held(way.yaw, p.friction.yaw_radps2)) {
    hold<&DrivenSlopes::r>(out.rates.r_radps, out);
    a.r_u = a.r_v = a.r_r = a.r_steering = 0.0;
  } else if (p.friction.yaw_radps2 > 0.0) {
    brake<&DrivenSlopes::r>(way.yaw, p.friction.yaw_radps2, p.per_inertia, ParameterId::kYawCoulomb,
                            ExtraForce::kYawStribeck, ParameterId::kInertiaNorm, out.rates.r_radps,
                            out);
  }
}

}  // namespace awmr
