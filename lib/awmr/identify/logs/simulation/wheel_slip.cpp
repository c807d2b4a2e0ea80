#include "awmr/identify/logs/simulation/wheel_slip.h"

#include <cmath>

namespace awmr {
namespace {

struct Side {
  double SideForces<double>::*force;
  double offset_m;  ///< distance to the left of the centre; the side moves at u - offset_m r
  double share;     ///< change of the reading per slip speed of this side
};

/// Force F' that a wheel of one side exerts on the ground, and its derivatives.
struct GroundForce {
  double value = 0.0;
  double by_command = 0.0;    ///< with respect to the command of the side
  double by_dead_zone = 0.0;  ///< with respect to the dead zone F'0
  double by_speed = 0.0;      ///< with respect to the speed w of the side over ground
  double by_back_emf = 0.0;   ///< with respect to the back-EMF k_e
};

GroundForce ground_force(double command, double w, const Plant<double>& plant) {
  if (!(std::abs(command) > plant.wheel_dead_zone)) return {};
  const double sign = std::copysign(1.0, command);
  const double k = plant.back_emf_s_per_m;
  return {.value = command - sign * plant.wheel_dead_zone - k * w,
          .by_command = 1.0,
          .by_dead_zone = -sign,
          .by_speed = -k,
          .by_back_emf = -w};
}

/// Adds to `by_column` the derivatives of the reading with respect to the columns of the fit, as
/// far as they are due to the slip of one side. `size`, `by_speed`: derivatives of the slip speed
/// with respect to the wheel force F' and to the speed w of the side over ground, each multiplied
/// by Side::share.
void add_columns(const Side& side, const SlippingWheels& wheels, const DelayedCommand& command,
                 const GroundForce& f, double size, double by_speed, const LinearMotion& motion,
                 std::size_t columns, double* by_column) {
  const double* const by_u = motion.row(LogChannel::kSpeed, columns);
  const double* const by_r = motion.row(LogChannel::kYawRate, columns);
  for (std::size_t c = 0; c < columns; ++c) {
    by_column[c] += by_speed * (by_u[c] - side.offset_m * by_r[c]);
  }
  for_each_column(wheels.terms, command, [&](std::size_t column, const HeldCommand& by) {
    by_column[column] += size * f.by_command * by.force.*side.force;
  });
  for (const ParameterColumn& p : wheels.parameters) {
    if (p.id == ParameterId::kWheelDeadZone)
      by_column[p.column] += size * f.by_dead_zone * p.factor;
    if (p.id == ParameterId::kBackEmf) by_column[p.column] += size * f.by_back_emf * p.factor;
  }
}

}  // namespace

double add_wheel_slip(const WheelSlip& slip, const SlippingWheels& wheels,
                      const DelayedCommand& command, const LinearMotion& motion,
                      std::size_t columns, double* by_column) {
  const double d = wheels.plant.half_track_m;
  const bool is_speed = slip.channel == LogChannel::kSpeed;
  const Side sides[] = {{&SideForces<double>::left, d, is_speed ? 0.5 : -0.5 / d},
                        {&SideForces<double>::right, -d, is_speed ? 0.5 : 0.5 / d}};
  double added = 0.0;
  for (const Side& side : sides) {
    const double w = motion.state.u_mps - side.offset_m * motion.state.r_radps;
    const double sign = w > 0.0 ? 1.0 : w < 0.0 ? -1.0 : 0.0;
    const double per_force = slip.is_ratio ? std::abs(w) : std::abs(sign);
    const GroundForce f = ground_force(command.command.force.*side.force, w, wheels.plant);
    const double own = side.share * per_force * f.value;
    const double size = side.share * slip.slip.value * per_force;
    added += slip.slip.value * own;
    if (columns == 0) continue;
    const double by_speed =
        size * f.by_speed + (slip.is_ratio ? side.share * slip.slip.value * f.value * sign : 0.0);
    add_columns(side, wheels, command, f, size, by_speed, motion, columns, by_column);
    by_column[slip.slip.column] += own;
  }
  return added;
}

}  // namespace awmr
