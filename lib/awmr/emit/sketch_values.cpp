#include "sketch_values.h"

#include <algorithm>
#include <optional>

#include "awmr/control/allocation.h"
#include "awmr/core/units.h"
#include "awmr/emit/emit.h"
#include "awmr/model/steady.h"

namespace awmr {
namespace {

/// Returns AWMR_ROUTE_SPEED_MPS: 1 m/s, but at most 0.6 times the top speed, at which no force is
/// left for turning.
double route_speed_mps(const Plant<double>& plant, double full_force) {
  constexpr double kUsual_mps = 1.0;
  constexpr double kShare = 0.6;
  const double viscous = 4.0 * plant.back_emf_s_per_m;
  const double top_mps = steady_rate(plant.surge, full_force, viscous).value_or(kUsual_mps);
  return std::min(kUsual_mps, kShare * top_mps);
}

/// Fastest steady yaw rate of the vehicle at a speed, rad/s, with the largest yaw moment tau_turn.
/// Absent if this does not exceed the resistance at rest. tau_speed: surge force at this speed,
/// l_f: distance of the front axle, d_max: steering stop, d: half track:
///   tau_turn = l_f tau_speed tan(d_max/2)                by steering            [paper (41)]
///   tau_turn = d (4 F'max - tau_speed)                   by the wheel forces
std::optional<double> turn_of_vehicle(const Plant<double>& plant, const Vehicle& vehicle,
                                      double full_force, double speed_mps) {
  const double tau_speed = plant.surge.at(speed_mps);
  const double moment_m = vehicle.has_steering() ? plant.front_axle_m * tau_speed *
                                                       tan_half(radians(vehicle.steering_max_deg))
                                                 : plant.half_track_m * (full_force - tau_speed);
  return steady_rate(plant.yaw, moment_m);
}

/// Yaw moment, divided by F_max, m, of motors whose forces differ in spite of equal commands: 0.08
/// d tau_speed if the left and right forces differ by 16 % of their mean (assumed). d: half of the
/// track width, tau_speed: surge force.
double unequal_moment_m(const Plant<double>& plant, double speed_mps) {
  return 0.08 * plant.half_track_m * plant.surge.at(speed_mps);
}

/// Fastest steady yaw rate r that the heading law reaches at a speed, rad/s, under two assumed
/// unfavourable conditions: the yaw resistance is 1.4 times the g3 of the model, and the forces of
/// the motors differ by 16 %, which takes the moment 0.08 d tau_speed (d: half of the track width,
/// tau_speed: surge force). Outside of the boundary layer of the law (gains mu, lambda; sat = 1), r
/// is the solution of
///   1.4 g3(r) + 0.08 d tau_speed = g3(r) + I'z (mu - lambda r)                 [paper (89)]
std::optional<double> turn_of_law(const Plant<double>& plant, const HeadingGains<double>& gains,
                                  double speed_mps) {
  constexpr double kMore = 0.4;
  return steady_rate(plant.yaw,
                     (plant.inertia_norm * gains.mu - unequal_moment_m(plant, speed_mps)) / kMore,
                     plant.inertia_norm * gains.lambda / kMore);
}

/// Heading error e, rad, that remains if the forces of the motors differ by 16 %. At yaw rate 0 and
/// inside its boundary layer, the heading law (heading_law.h; gains lambda, mu, epsilon) balances
/// the moment of these motors. I'z: yaw inertia divided by F_max:
///   0.08 d tau_speed = I'z lambda (mu/epsilon) e
double steady_error_rad(const Plant<double>& plant, const HeadingGains<double>& gains,
                        double route_mps) {
  const double stiffness_m = plant.inertia_norm * gains.lambda * gains.mu / gains.epsilon;
  return unequal_moment_m(plant, route_mps) / stiffness_m;
}

/// Returns AWMR_ON_COURSE_RAD, rad: twice the steady heading error, within 15 to 45 deg.
double on_course_rad(double error_rad) {
  return std::clamp(2.0 * error_rad, radians(15.0), kMaxOnCourse_rad);
}

/// Returns AWMR_OFF_COURSE_MRAD, m rad, the limit of fault 17. The detector
/// (emit/board/motion_check.h) integrates (heading error - e0) over the distance, with e0 =
/// `on_course_rad`. Even without a failure, a turn by 180 deg with the radius R adds R (pi -
/// e0)^2/2. The limit is this amount plus 10 m rad for the distance until the turn begins, but at
/// most 90 m rad. R is the largest turning radius at 1/4, 1/2, 3/4 and all of the route's speed,
/// because friction at rest can make slow turns wide.
double off_course_mrad(const Plant<double>& plant, const Vehicle& vehicle,
                       const HeadingGains<double>& gains, double full_force, double route_mps,
                       double on_course_rad) {
  constexpr double kMin_mrad = 10.0;
  constexpr double kMax_mrad = 90.0;
  const double beyond_rad = radians(180.0) - on_course_rad;
  double most = kMin_mrad;
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    const double speed_mps = share * route_mps;
    const auto by_vehicle = turn_of_vehicle(plant, vehicle, full_force, speed_mps);
    const auto by_law = turn_of_law(plant, gains, speed_mps);
    if (!by_vehicle || !by_law) return kMax_mrad;
    const double radius_m = speed_mps / std::min(*by_vehicle, *by_law);
    most = std::max(most, kMin_mrad + 0.5 * beyond_rad * beyond_rad * radius_m);
  }
  return std::min(most, kMax_mrad);
}

}  // namespace

SketchValues sketch_values(const Plant<double>& plant, const Vehicle& vehicle,
                           const ModeGains& gains, double full_force) {
  SketchValues values{.route_mps = route_speed_mps(plant, full_force)};
  for (const YawMode mode : kYawModes) {
    const double error_rad = steady_error_rad(plant, gains.in(mode).heading, values.route_mps);
    values.steady_error_rad = std::max(values.steady_error_rad, error_rad);
  }
  values.on_course_rad = on_course_rad(values.steady_error_rad);
  for (const YawMode mode : kYawModes) {
    const double limit_mrad = off_course_mrad(plant, vehicle, gains.in(mode).heading, full_force,
                                              values.route_mps, values.on_course_rad);
    values.off_course_mrad = std::max(values.off_course_mrad, limit_mrad);
  }
  return values;
}

}  // namespace awmr
