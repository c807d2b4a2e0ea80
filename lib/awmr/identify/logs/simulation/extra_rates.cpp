#include "awmr/identify/logs/simulation/extra_rates.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "awmr/core/index.h"

namespace awmr {
namespace {

WheelForce wheel_force(double command, double zone) {
  if (command > zone) return {command - zone, 1.0, -1.0};
  if (command < -zone) return {command + zone, 1.0, 1.0};
  const double slope = zone > 0.0 ? 0.0 : 1.0;  // without a dead zone, the force follows from 0 on
  return {0.0, slope, 0.0};
}

/// Multiplies the force of a wheel by 1 + e_b if it acts against the motion of its side, and by 1 +
/// e_r if it is negative. `w_mps`: speed of that side. To keep the rates continuous, the effect of
/// e_b rises linearly from 0 at rest to its full size at a small speed. The derivatives of the
/// force treat this small speed as constant.
ByExcess scale_by_excess(const LinearPlant& plant, double w_mps, WheelForce& wheel) {
  constexpr double kFade_mps = 0.002;
  constexpr double kWheels = 4.0;
  const double pure = wheel.value;
  const double e_b = plant.extra[ExtraForce::kBrakeForce];
  const double fade_mps = std::max(kFade_mps, kWheels * std::abs(e_b * pure) * plant.step_per_mass);
  const double slope = -std::copysign(1.0 / fade_mps, pure);
  const double wanted = slope * w_mps;
  const double braking = std::clamp(wanted, 0.0, 1.0);
  const double brake = 1.0 + braking * e_b;
  const bool reverses = pure < 0.0;
  const double reverse = reverses ? 1.0 + plant.extra[ExtraForce::kReverseForce] : 1.0;
  wheel = {pure * brake * reverse, wheel.by_command * brake * reverse,
           wheel.by_dead_zone * brake * reverse};
  return {.by_brake = braking * pure * reverse,
          .by_reverse = reverses ? pure * brake : 0.0,
          .by_speed = braking == wanted ? slope * e_b * pure * reverse : 0.0};
}

/// Half of the track width d, m, with which the motors of one side turn at the speed u -+ d r.
/// Returns 0 if left and right commands never differ: the vehicle may then have a single motor,
/// which turns at the speed u.
double motor_side_m(const LinearPlant& plant) {
  return plant.extra.has_motor_per_side ? plant.plant.half_track_m : 0.0;
}

/// Vector of three numbers, one each for u, v and r; or a row of a 3 x 3 matrix.
using Vector3 = std::array<double, 3>;

/// Adds share times a b^T to the matrix `to`.
void add_product(double share, const Vector3& a, const Vector3& b, std::array<Vector3, 3>& to) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) to[i][j] += share * a[i] * b[j];
  }
}

/// Damping matrix D of back-EMF. A wheel rolls at the speed w = J (u, v, r), with a 1 x 3 matrix J.
/// Its force F' acts on the vehicle as (X, Y, N) = J^T F'. Back-EMF reduces F' by k_e w, so
///
///     (X, Y, N) -= k_e D (u, v, r),   D = sum J^T J over the wheels whose motor is on
///     J_rear = (1, 0, -+d),   J_front = (cos d_r, sin d_r, l_f sin d_r -+ d cos d_r)
///
/// The upper sign is for left wheels, the lower for right wheels. d: half of the track width; l_f:
/// distance of the front axle ahead of the centre of gravity; d_r: steering angle.
struct Braking {
  std::array<Vector3, 3> by_motion{};    ///< D
  std::array<Vector3, 3> by_steering{};  ///< d D / d d_r
};

void add_side(const Plant<double>& p, double left_m, double sin_d, double cos_d, Braking& braking) {
  const Vector3 rear{1.0, 0.0, -left_m};
  const Vector3 front{cos_d, sin_d, p.front_axle_m * sin_d - left_m * cos_d};
  const Vector3 turned{-sin_d, cos_d, p.front_axle_m * cos_d + left_m * sin_d};
  add_product(p.rear_driven, rear, rear, braking.by_motion);
  add_product(1.0, front, front, braking.by_motion);
  add_product(1.0, turned, front, braking.by_steering);
  add_product(1.0, front, turned, braking.by_steering);
}

}  // namespace

Wheels wheels_of(const LinearPlant& plant, const State<double>& s,
                 const SideForces<double>& force) {
  const double zone = plant.plant.wheel_dead_zone;
  Wheels wheels{wheel_force(force.left, zone), wheel_force(force.right, zone)};
  if (!plant.has_force_excess) return wheels;
  const double swing_mps = motor_side_m(plant) * s.r_radps;
  wheels.left_excess = scale_by_excess(plant, s.u_mps - swing_mps, wheels.left);
  wheels.right_excess = scale_by_excess(plant, s.u_mps + swing_mps, wheels.right);
  return wheels;
}

void add_wheel_slopes(const LinearPlant& plant, const Wheels& wheels, const ByForces& forces,
                      LinearRates& out) {
  const auto& [left, right, left_excess, right_excess] = wheels;
  out.by_force_left = forces.of(left.by_command, 0.0);
  out.by_force_right = forces.of(0.0, right.by_command);
  out.by_parameter[at(ParameterId::kWheelDeadZone)] =
      forces.of(left.by_dead_zone, right.by_dead_zone);
  if (!plant.has_force_excess) return;
  out.by_extra[at(ExtraForce::kBrakeForce)] =
      forces.of(left_excess.by_brake, right_excess.by_brake);
  out.by_extra[at(ExtraForce::kReverseForce)] =
      forces.of(left_excess.by_reverse, right_excess.by_reverse);
  const double side_m = motor_side_m(plant);
  const DrivenSlopes by_u = forces.of(left_excess.by_speed, right_excess.by_speed);
  const DrivenSlopes by_r =
      forces.of(-side_m * left_excess.by_speed, side_m * right_excess.by_speed);
  StateSlopes& a = out.by_state;
  a.u_u += by_u.u;
  a.u_r += by_r.u;
  a.v_u += by_u.v;
  a.v_r += by_r.v;
  a.r_u += by_u.r;
  a.r_r += by_r.r;
}

namespace {

/// Subtracts s (1 - exp(-(w/w_s)^2)) from the resistance g at the speed w. Reason: add_friction()
/// adds the friction at rest, c + s (Coulomb and Stribeck), at every speed. The sum of both is c +
/// s at rest, and decreases to c at high speed.
template <double DrivenSlopes::*kRate>
void subtract_stribeck(const ExtraForces& extra, ExtraForce force, ExtraForce speed, double w,
                       double per_inertia, ResistanceSlopes& g, LinearRates& out) {
  const double size = extra[force];
  const double scale = extra[speed];
  const double ratio = w / scale;
  const double rest = std::exp(-ratio * ratio);
  const double sign = w > 0.0 ? 1.0 : w < 0.0 ? -1.0 : 0.0;
  const double by_ratio = 2.0 * size * rest * std::abs(ratio);
  g.value -= sign * size * (1.0 - rest);
  g.by_speed -= by_ratio / scale;
  out.by_extra[at(force)].*kRate = sign * (1.0 - rest) * per_inertia;
  out.by_extra[at(speed)].*kRate = -by_ratio * ratio / scale * per_inertia;
}

/// Multiplies the surge resistance g, including its Stribeck friction, by 1 + e_g if the vehicle
/// drives backward. add_friction() does the same for the friction at rest, which is not part of g.
void add_backward_drag(const LinearPlant& plant, double u_mps, ResistanceSlopes& g,
                       LinearRates& out) {
  DrivenSlopes& by = out.by_extra[at(ExtraForce::kBackwardDrag)];
  by.u = 0.0;
  if (!(u_mps < 0.0)) return;
  by.u = -g.value * plant.per_mass;
  const double share = 1.0 + plant.extra[ExtraForce::kBackwardDrag];
  for (double* const part :
       {&g.value, &g.by_speed, &g.by_alpha, &g.by_beta, &g.by_coulomb, &g.by_quadratic}) {
    *part *= share;
  }
  if (!plant.has_surge_stribeck) return;
  out.by_extra[at(ExtraForce::kSurgeStribeck)].u *= share;
  out.by_extra[at(ExtraForce::kSurgeStribeckSpeed)].u *= share;
}

}  // namespace

void add_back_emf(const LinearPlant& plant, const State<double>& s, bool left_on, bool right_on,
                  double sin_d, double cos_d, LinearRates& out) {
  const Plant<double>& p = plant.plant;
  Braking braking;
  if (left_on) add_side(p, p.half_track_m, sin_d, cos_d, braking);
  if (right_on) add_side(p, -p.half_track_m, sin_d, cos_d, braking);
  const Vector3 motion{s.u_mps, s.v_mps, s.r_radps};
  const Vector3 per_inertia{plant.per_mass, plant.per_mass, plant.per_inertia};
  const auto along = [&](const std::array<Vector3, 3>& matrix, std::size_t row) {
    return per_inertia[row] *
           (matrix[row][0] * motion[0] + matrix[row][1] * motion[1] + matrix[row][2] * motion[2]);
  };
  const Vector3 rate{along(braking.by_motion, 0), along(braking.by_motion, 1),
                     along(braking.by_motion, 2)};
  const double k = p.back_emf_s_per_m;
  auto& by = out.by_parameter;
  by[at(ParameterId::kBackEmf)] = {.u = -rate[0], .v = -rate[1], .r = -rate[2]};
  by[at(ParameterId::kMassNorm)].u += k * rate[0] * plant.per_mass;
  by[at(ParameterId::kMassNorm)].v += k * rate[1] * plant.per_mass;
  by[at(ParameterId::kInertiaNorm)].r += k * rate[2] * plant.per_inertia;
  out.rates.u_mps -= k * rate[0];
  out.rates.v_mps -= k * rate[1];
  out.rates.r_radps -= k * rate[2];
  StateSlopes& a = out.by_state;
  const auto slope = [&](std::size_t i, std::size_t j) {
    return k * per_inertia[i] * braking.by_motion[i][j];
  };
  a.u_u -= slope(0, 0);
  a.u_v -= slope(0, 1);
  a.u_r -= slope(0, 2);
  a.v_u -= slope(1, 0);
  a.v_v -= slope(1, 1);
  a.v_r -= slope(1, 2);
  a.r_u -= slope(2, 0);
  a.r_v = -slope(2, 1);
  a.r_r -= slope(2, 2);
  a.u_steering -= k * along(braking.by_steering, 0);
  a.v_steering -= k * along(braking.by_steering, 1);
  a.r_steering -= k * along(braking.by_steering, 2);
}

ResistanceSlopes surge_resistance(const LinearPlant& plant, double u_mps, LinearRates& out) {
  ResistanceSlopes g = plant.surge(u_mps);
  if (plant.has_surge_stribeck) {
    subtract_stribeck<&DrivenSlopes::u>(plant.extra, ExtraForce::kSurgeStribeck,
                                        ExtraForce::kSurgeStribeckSpeed, u_mps, plant.per_mass, g,
                                        out);
  }
  add_backward_drag(plant, u_mps, g, out);
  return g;
}

ResistanceSlopes yaw_resistance(const LinearPlant& plant, double r_radps, LinearRates& out) {
  ResistanceSlopes g = plant.yaw(r_radps);
  if (plant.has_yaw_stribeck) {
    subtract_stribeck<&DrivenSlopes::r>(plant.extra, ExtraForce::kYawStribeck,
                                        ExtraForce::kYawStribeckSpeed, r_radps, plant.per_inertia,
                                        g, out);
  }
  return g;
}

TurnDrag turn_drag(const LinearPlant& plant, const State<double>& s) {
  constexpr double kRest_mps = 0.02;
  if (!plant.has_turn_drag) return {};
  const ResistanceSlopes of_yaw = plant.turn_drag_of_yaw(s.r_radps);  // k |r|^p sgn r
  const double rest_mps = std::max(kRest_mps, std::abs(of_yaw.value) * plant.step_per_mass);
  const double speed_mps = std::max(std::abs(s.u_mps), rest_mps);
  const double q = plant.extra[ExtraForce::kTurnDragSpeedExponent];
  const double of_speed =
      std::pow(speed_mps, q) * math::saturate(s.u_mps / rest_mps, 1.0);  // |u|^q sgn u
  const double share = s.r_radps < 0.0 ? -of_speed : of_speed;
  const bool is_slow = std::abs(s.u_mps) < rest_mps;
  const double by_log_speed = is_slow ? 1.0 : q;
  return {.value = share * of_yaw.value,
          .by_speed = by_log_speed * std::abs(of_yaw.value) * std::pow(speed_mps, q - 1.0),
          .by_yaw_rate = share * of_yaw.by_speed,
          .by_size = share * of_yaw.by_alpha,
          .by_exponent = share * of_yaw.by_beta,
          .by_speed_exponent = share * of_yaw.value * std::log(speed_mps)};
}

void add_turn_drag(const TurnDrag& drag, double per_mass, LinearRates& out) {
  auto& by = out.by_extra;
  by[at(ExtraForce::kTurnDrag)].u = -drag.by_size * per_mass;
  by[at(ExtraForce::kTurnDragExponent)].u = -drag.by_exponent * per_mass;
  by[at(ExtraForce::kTurnDragSpeedExponent)].u = -drag.by_speed_exponent * per_mass;
}

void add_side_pull(const LinearPlant& plant, double u_mps, LinearRates& out) {
  constexpr double kRest_mps = 0.02;  // w_0: the moment is proportional to u below this speed
  const double pull_m = plant.extra[ExtraForce::kSidePull];
  const double way = math::saturate(u_mps / kRest_mps, 1.0);
  out.rates.r_radps += way * pull_m * plant.per_inertia;
  if (std::abs(u_mps) < kRest_mps) out.by_state.r_u += pull_m / kRest_mps * plant.per_inertia;
  out.by_extra[at(ExtraForce::kSidePull)].r = way * plant.per_inertia;
}

void add_axle_offset(const LinearPlant& plant, const State<double>& s, LinearRates& out) {
  const double offset_m = plant.extra[ExtraForce::kAxleOffset];
  const double ratio = plant.plant.mass_norm * plant.per_inertia;  // m'/I'z
  const double of_yaw = -ratio * s.u_mps * s.r_radps;              // d r_dot / d x_c
  out.rates.u_mps += offset_m * s.r_radps * s.r_radps;
  out.rates.r_radps += offset_m * of_yaw;
  out.by_state.u_r += 2.0 * offset_m * s.r_radps;
  out.by_state.r_u -= offset_m * ratio * s.r_radps;
  out.by_state.r_r -= offset_m * ratio * s.u_mps;
  out.by_extra[at(ExtraForce::kAxleOffset)] = {.u = s.r_radps * s.r_radps, .r = of_yaw};
  out.by_parameter[at(ParameterId::kMassNorm)].r = offset_m * of_yaw * plant.per_mass;
  out.by_parameter[at(ParameterId::kInertiaNorm)].r -= offset_m * of_yaw * plant.per_inertia;
}

void add_slope(const ExtraForces& extra, double psi_rad, LinearRates& out) {
  const double c = std::cos(psi_rad);
  const double d = std::sin(psi_rad);
  const double along = extra[ExtraForce::kSlopeX] * c + extra[ExtraForce::kSlopeY] * d;
  const double across = extra[ExtraForce::kSlopeY] * c - extra[ExtraForce::kSlopeX] * d;
  out.rates.u_mps += along;
  out.rates.v_mps += across;
  out.by_state.u_psi = across;
  out.by_state.v_psi = -along;
  out.by_extra[at(ExtraForce::kSlopeX)] = {.u = c, .v = -d};
  out.by_extra[at(ExtraForce::kSlopeY)] = {.u = d, .v = c};
}

}  // namespace awmr
