/// Accumulates the metrics of a run while it is simulated. Each row is processed once, so rows need
/// not be stored. Templates on the scalar type: double for a single run, or lanes::Lanes, a
/// register with one run per lane. Private to this folder.
#pragma once

#include "awmr/control/controller.h"
#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/resistance.h"
#include "awmr/model/state.h"

namespace awmr {

/// Data of the vehicle that the metrics need. They are taken from its controller.
template <class T>
struct MetricsVehicle {
  T front_axle_m;      ///< l_f, m
  T half_track_m;      ///< d, m
  T force_max;         ///< F'max of one wheel, without the dead zone
  T command_max;       ///< the command that makes F'max
  T command_min;       ///< the command that makes F'min
  T steering_max_rad;  ///< d_max, rad; 0: no steering
  T dead_zone;         ///< dead zone F'0 of the motors, divided by F_max
  T back_emf_s_per_m;  ///< k_e of the motors, s/m
  T rear_driven;       ///< 1: all wheels are driven; 0: only the front wheels
  /// Yaw resistance g3 in the controller's model, without a chord at rest: the work against it does
  /// not depend on the friction width of the gains.
  Resistance<T> yaw;
};

/// Properties of the scenario that the metrics need. They are the same for all runs.
struct MetricsTask {
  bool has_headings = false;  ///< the guidance has heading steps
  double speed_mps = 0.0;     ///< commanded speed u_d; the speed drop is measured from it
  /// Largest allowed distance from the point of a timed path in the second half of the run, m.
  double tolerance_m = 0.0;
  /// Definition of tyre work. true: work of the lateral tyre forces; false: work against the yaw
  /// resistance g3 and the tyre scrub.
  bool is_on_tyres = false;
};

/// Input of the metrics for one row.
template <class T>
struct MetricsRow {
  State<T> state;
  SideForces<T> force;     ///< motor commands, divided by F_max: RunRow::force
  WheelForces<T> acting;   ///< forces over the sample that ends at this row: RunRow::acting
  T steering_command_rad;  ///< d_ro: commanded steering angle, rad
  T goal_rad;              ///< desired heading of the guidance, before avoidance and shaping
  T cross_track_m;         ///< distance from the current leg, line or path, left positive
  T off_target_m;          ///< distance from the guidance's target point (PathRow::target_m)
  T clearance_m;           ///< distance to the nearest obstacle; 0 without obstacles
  T speed_ref_mps;         ///< u_d, reference of the speed law
  T tyre_power_mps;        ///< RunRow::tyre_power_mps
};

/// Time of a row; the same for all runs.
struct MetricsTime {
  double t_s = 0.0;
  double since_last_s = 0.0;  ///< time since the previous row; 0 in the first row
  bool is_first = false;
  /// True in the first row, and if the commanded heading differs from that of the previous row.
  bool starts_step = false;
  /// the row is in the second half of the run; always false without a timed path
  bool is_in_second_half = false;
};

/// Sums and other values of the metrics over the rows so far. All members are of type T; flags are
/// 0 or 1.
template <class T>
struct MetricsAccumulator {
  T rows = T(0.0);
  T effort = T(0.0);
  T sideslip_max_deg = T(0.0);
  T yaw_rate_max_degps = T(0.0);
  T path_length_m = T(0.0);
  T variation = T(0.0);
  T energy_mech = T(0.0);
  T energy_electric = T(0.0);
  T tyre_work = T(0.0);
  T saturation_s = T(0.0);
  T steering_travel_deg = T(0.0);
  T cross_track_m2 = T(0.0);
  /// flag: in the second half of the run, the vehicle was more than tolerance_m from the moving
  /// point of the path
  T strayed = T(0.0);
  T clearance_min_m = T(0.0);
  T speed_reached = T(0.0);  ///< flag: the speed has reached the commanded one
  T speed_least_mps = T(0.0);
  T speed_itae_m_s = T(0.0);
  T steering_rate2_degps2 = T(0.0);  ///< sum of the squared rates of the commanded steering angle
  // Heading steps: values over all steps, then values of the current step.
  T settling_s = T(0.0);
  T never_settled = T(0.0);  ///< flag: the heading did not settle in one of the steps
  T overshoot_deg = T(0.0);
  T iae_degs = T(0.0);
  T itae_degs2 = T(0.0);
  T step_start_s = T(0.0);
  T step_deg = T(0.0);
  T out_of_band = T(0.0);  ///< flag: the heading error is outside the settling band
  T settled_s = T(0.0);    ///< time from the step to the last entry of the error into the band
  // Values of the previous row.
  T error_deg = T(0.0);
  T speed_error_m = T(0.0);  ///< t |u_d - u|
  T t_s = T(0.0);
  WheelSpeeds<T> rolling{T(0.0), T(0.0), T(0.0), T(0.0)};
  T yaw_resistance_m = T(0.0), r_radps = T(0.0);
  T tyre_power_mps = T(0.0);
  T limited = T(0.0);  ///< flag: a motor or steering command was at a limit
  T x_m = T(0.0), y_m = T(0.0), steering_rad = T(0.0);
  T steering_command_rad = T(0.0), left = T(0.0), right = T(0.0);
};

namespace meter {

/// The commanded speed counts as reached if at most this fraction of it is missing.
constexpr double kReachedShare = 0.001;
/// Half width of the settling band of the heading error, divided by the size of the heading step;
/// the narrower the band, the longer the settling times.
constexpr double kSettledShare = 0.02;
constexpr double kSettledLeastDeg = 0.5;  ///< smallest half width of the settling band, deg
constexpr double kMovingMps = 0.05;       ///< the sideslip angle is evaluated above this speed, m/s

using math::larger;

/// Mechanical power and copper loss of the four motors during one sample.
template <class T>
struct MotorWork {
  /// Power divided by F_max: sum over the wheels of max(0, F' w), with the wheel speed w.
  T power_mps;
  T copper;  ///< half the sum of F'^2 over the wheels
};

template <class T>
MotorWork<T> motor_work(const WheelForces<T>& f, const WheelSpeeds<T>& w,
                        const MetricsVehicle<T>& vehicle) {
  using math::any;
  const auto power = [](const T& force, const T& wheel_mps) {
    return larger(T(0.0), T(force * wheel_mps));
  };
  if (!any(vehicle.back_emf_s_per_m > T(0.0) || vehicle.dead_zone > T(0.0) ||
           vehicle.rear_driven < T(1.0))) {
    return {(power(f.rear_left, w.rear_left) + power(f.front_left, w.front_left)) +
                (power(f.rear_right, w.rear_right) + power(f.front_right, w.front_right)),
            T(0.5) * ((f.rear_left * f.rear_left + f.front_left * f.front_left) +
                      (f.rear_right * f.rear_right + f.front_right * f.front_right))};
  }
  MotorWork<T> work{T(0.0), T(0.0)};
  const auto add = [&](const T& command, const T& wheel_mps) {
    const T drive = beyond_dead_zone(command, vehicle.dead_zone);
    const T force = motor_force(drive, vehicle.back_emf_s_per_m, wheel_mps);
    work.power_mps += power(force, wheel_mps);
    work.copper += T(0.5) * force * force;
  };
  add(f.front_left, w.front_left);
  add(f.front_right, w.front_right);
  add(f.rear_left, w.rear_left);
  add(f.rear_right, w.rear_right);
  return work;
}

/// True if a motor command is at a limit of its force, or the steering command is at +-d_max.
template <class T>
Mask<T> at_a_limit(const MetricsRow<T>& row, const MetricsVehicle<T>& vehicle) {
  using math::abs;
  const auto forced = [&](const T& command) {
    return command >= vehicle.command_max || command <= vehicle.command_min;
  };
  return forced(row.force.left) || forced(row.force.right) ||
         (vehicle.steering_max_rad > T(0.0) &&
          abs(row.steering_command_rad) >= vehicle.steering_max_rad);
}

/// Returns a steering angle divided by the largest one; 0 for a vehicle without steering.
template <class T>
T share_of_stop(const T& steering_rad, const T& steering_max_rad) {
  using math::select;
  const Mask<T> steers = steering_max_rad > T(0.0);
  return select(steers, T(steering_rad / select(steers, steering_max_rad, T(1.0))), T(0.0));
}

/// Ends the current heading step: updates the longest settling time or, if the heading has not
/// settled, sets the flag never_settled.
template <class T>
void close_step(MetricsAccumulator<T>& m) {
  using math::select;
  const Mask<T> settled = !(m.out_of_band > T(0.0));
  m.never_settled = select(settled, m.never_settled, T(1.0));
  m.settling_s = select(settled, larger(m.settling_s, m.settled_s), m.settling_s);
}

/// Adds a row to the heading metrics: settling time, overshoot, IAE (integral of the absolute
/// error) and ITAE (the same, weighted with the time since the step).
template <class T>
void measure_heading(const MetricsRow<T>& row, const MetricsTime& time, MetricsAccumulator<T>& m) {
  using math::abs;
  using math::select;
  const T error_deg = degrees(wrap_angle(T(row.goal_rad - row.state.psi_rad)));
  if (!time.is_first) {
    const T dt_s = T(time.since_last_s);
    m.iae_degs += abs(m.error_deg) * dt_s;
    m.itae_degs2 += (m.t_s - m.step_start_s) * abs(m.error_deg) * dt_s;
  }
  if (time.starts_step) {
    if (!time.is_first) close_step(m);
    m.step_start_s = T(time.t_s);
    m.step_deg = error_deg;
    m.out_of_band = T(0.0);
    m.settled_s = T(0.0);
  }
  const T band_deg = larger(T(T(kSettledShare) * abs(m.step_deg)), T(kSettledLeastDeg));
  const Mask<T> out = abs(error_deg) > band_deg;
  const Mask<T> enters = !out && m.out_of_band > T(0.0);
  m.settled_s = select(enters, T(T(time.t_s) - m.step_start_s), m.settled_s);
  m.out_of_band = select(out, T(1.0), T(0.0));
  m.overshoot_deg = larger(m.overshoot_deg, select(m.step_deg > T(0.0), T(-error_deg), error_deg));
  m.error_deg = error_deg;
}

/// Updates the smallest speed since the vehicle first reached 99.9 % of the commanded speed.
template <class T>
void measure_speed(const T& u_mps, const MetricsTask& task, MetricsAccumulator<T>& m) {
  using math::select;
  const Mask<T> was = m.speed_reached > T(0.0);
  const Mask<T> counts = was || u_mps >= T((1.0 - kReachedShare) * task.speed_mps);
  const T least = select(was && !(u_mps < m.speed_least_mps), m.speed_least_mps, u_mps);
  m.speed_least_mps = select(counts, least, m.speed_least_mps);
  m.speed_reached = select(counts, T(1.0), T(0.0));
}

/// Updates the integral of t |u_d - u| (t: time, u_d: desired speed, u: speed) by the trapezoidal
/// rule.
template <class T>
void measure_speed_error(const MetricsRow<T>& row, const MetricsTime& time,
                         MetricsAccumulator<T>& m) {
  using math::abs;
  const T error_m = T(time.t_s) * abs(row.speed_ref_mps - row.state.u_mps);
  if (!time.is_first) {
    m.speed_itae_m_s += T(0.5 * time.since_last_s) * (m.speed_error_m + error_m);
  }
  m.speed_error_m = error_m;
}

/// Updates path length, sideslip, yaw rate, control effort and control variation.
template <class T>
void measure_motion(const MetricsRow<T>& row, const MetricsVehicle<T>& vehicle, bool is_first,
                    MetricsAccumulator<T>& m) {
  using math::abs;
  using math::any;
  using math::atan2;
  using math::hypot;
  using math::select;
  const State<T>& s = row.state;
  const T steering = share_of_stop(row.steering_command_rad, vehicle.steering_max_rad);
  m.effort +=
      row.force.left * row.force.left + row.force.right * row.force.right + steering * steering;
  const Mask<T> moves = hypot(s.u_mps, s.v_mps) > T(kMovingMps);
  if (any(moves)) {
    const T sideslip_deg = abs(degrees(atan2(s.v_mps, abs(s.u_mps))));
    m.sideslip_max_deg =
        select(moves, larger(m.sideslip_max_deg, sideslip_deg), m.sideslip_max_deg);
  }
  m.yaw_rate_max_degps = larger(m.yaw_rate_max_degps, abs(degrees(s.r_radps)));
  if (is_first) return;
  m.path_length_m += hypot(T(s.x_m - m.x_m), T(s.y_m - m.y_m));
  m.variation +=
      share_of_stop(abs(row.steering_command_rad - m.steering_command_rad),
                    vehicle.steering_max_rad) +
      (abs(row.force.left - m.left) + abs(row.force.right - m.right)) / vehicle.force_max;
}

/// Adds the sample that ends at this row to energy, tyre work, time in saturation, steering travel
/// and steering rate. The forces are constant over the sample; the speeds are those at its start.
template <class T>
void measure_work(const MetricsRow<T>& row, const MetricsVehicle<T>& vehicle, bool is_on_tyres,
                  double dt_s, MetricsAccumulator<T>& m) {
  using math::abs;
  using math::select;
  const MotorWork<T> work = motor_work(row.acting, m.rolling, vehicle);
  m.energy_mech += T(dt_s) * work.power_mps;
  m.energy_electric += T(dt_s) * T(2.0) * work.copper;
  if (is_on_tyres) {
    m.tyre_work += T(dt_s) * m.tyre_power_mps;
  } else {
    m.tyre_work += T(dt_s) * m.yaw_resistance_m * m.r_radps;
    m.tyre_work += T(dt_s) * m.tyre_power_mps;  // the power of scrub
  }
  m.saturation_s = select(m.limited > T(0.0), T(m.saturation_s + T(dt_s)), m.saturation_s);
  m.steering_travel_deg += abs(degrees(row.state.steering_rad - m.steering_rad));
  const T rate_degps = degrees(row.steering_command_rad - m.steering_command_rad) * T(1.0 / dt_s);
  m.steering_rate2_degps2 += rate_degps * rate_degps;
}

/// Stores the values of this row that the differences and integrals of the next row need.
template <class T>
void remember(const MetricsRow<T>& row, const MetricsVehicle<T>& vehicle, double t_s,
              MetricsAccumulator<T>& m) {
  using math::select;
  m.t_s = T(t_s);
  m.rolling = wheel_speeds(vehicle.front_axle_m, vehicle.half_track_m, row.state);
  m.yaw_resistance_m = vehicle.yaw(row.state.r_radps);
  m.r_radps = row.state.r_radps;
  m.tyre_power_mps = row.tyre_power_mps;
  m.limited = select(at_a_limit(row, vehicle), T(1.0), T(0.0));
  m.x_m = row.state.x_m;
  m.y_m = row.state.y_m;
  m.steering_rad = row.state.steering_rad;
  m.steering_command_rad = row.steering_command_rad;
  m.left = row.force.left;
  m.right = row.force.right;
}

}  // namespace meter

/// Adds a row to the sums. Call it for every row, in order.
template <class T>
void measure(const MetricsRow<T>& row, const MetricsVehicle<T>& vehicle, const MetricsTask& task,
             const MetricsTime& time, MetricsAccumulator<T>& m) {
  using math::select;
  m.rows += T(1.0);
  if (task.has_headings) meter::measure_heading(row, time, m);
  meter::measure_motion(row, vehicle, time.is_first, m);
  if (!time.is_first) {
    meter::measure_work(row, vehicle, task.is_on_tyres, time.since_last_s, m);
  }
  meter::measure_speed(row.state.u_mps, task, m);
  meter::measure_speed_error(row, time, m);
  m.cross_track_m2 += row.cross_track_m * row.cross_track_m;
  if (time.is_in_second_half) {
    m.strayed = select(row.off_target_m <= T(task.tolerance_m), m.strayed, T(1.0));
  }
  m.clearance_min_m = select(Mask<T>(time.is_first) || row.clearance_m < m.clearance_min_m,
                             row.clearance_m, m.clearance_min_m);
  meter::remember(row, vehicle, time.t_s, m);
}

}  // namespace awmr
