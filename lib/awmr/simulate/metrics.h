/// Metrics of one run. They are the columns of comparison.csv, and tuning computes its cost from
/// them. A metric that has no meaning for the guidance of the run is absent, never 0.
#pragma once

#include <optional>

#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// The metrics of one run.
struct Metrics {
  /// True if the task was completed without touching an obstacle. Headings: every step settled.
  /// Waypoints: all were reached. Line: its end was reached. Timed path: the distance from its
  /// point was within the tolerance in the second half of the run.
  bool completed = true;
  /// Settling time, s: from a heading step until the heading error |e| stays within 2 % of the size
  /// of the step (at least 0.5 deg). The longest of all steps; absent if a step did not settle.
  std::optional<double> settling_time_s;
  /// Overshoot: largest angle by which the heading exceeds a commanded heading in the direction of
  /// its step, deg, >= 0.
  std::optional<double> overshoot_deg;
  std::optional<double> heading_iae_degs;    ///< integral of the heading error |e|, deg s
  std::optional<double> heading_itae_degs2;  ///< integral of t |e|, t since the step (for tuning)
  std::optional<double> cross_track_rms_m;   ///< RMS distance from the current leg, line or path
  double path_length_m = 0.0;                ///< length of the driven path
  /// Speed drop, m/s, >= 0: commanded speed minus the smallest speed since the speed first reached
  /// 99.9 % of it. Absent if the speed never did, or if the commanded speed is not constant
  /// (slow-down, avoidance, timed path).
  std::optional<double> speed_drop_mps;
  double speed_itae_m_s = 0.0;  ///< integral of t |u_d - u| (for tuning)
  /// Largest sideslip |atan2(v, |u|)|, deg, while driving forward or backward above 0.05 m/s.
  double sideslip_max_deg = 0.0;
  double yaw_rate_max_degps = 0.0;  ///< largest |r|, deg/s
  /// Sum of the total variations of the commanded d_r/d_max, F'L/F'max and F'R/F'max, divided by
  /// the duration of the run, 1/s.
  double control_variation = 0.0;
  double control_effort = 0.0;  ///< mean of F'L^2 + F'R^2 + (d_r/d_max)^2 over the run
  /// Smallest distance from the vehicle's circle to an obstacle, m; < 0 if they overlapped. Absent
  /// without obstacles.
  std::optional<double> clearance_min_m;
  /// Time, s, at which the last waypoint or the end of the line was reached. Absent if it was not
  /// reached, if a waypoint was missed, or if the vehicle overlapped an obstacle.
  std::optional<double> finish_time_s;

  /// Positive mechanical work of the motors, over F_max, m; braking recovers no energy:
  ///   integral of sum_i max(0, F'_i w_i)
  /// F'_i: RunRow::acting of wheel i, less dead zone and back-EMF; w_i: the wheel's speed in its
  /// rolling direction.
  double energy_mech = 0.0;
  /// Copper loss of the motors, relative to the loss of one motor at F_max, s: integral of sum_i
  /// F'_i^2, F'_i as in energy_mech.
  double energy_electric = 0.0;
  double saturation_s = 0.0;             ///< time, s, with a command at a limit of F' or of d_r
  double steering_travel_deg = 0.0;      ///< total variation of the actual steering angle d_r
  double steering_rate_rms_degps = 0.0;  ///< RMS rate of the commanded angle (for tuning)
  /// Work that wears the tyres, over F_max, m. 3-DOF model: the work against yaw resistance and
  /// scrub, integral of g3(r) r plus RunRow::tyre_power_mps. On tyres (Scenario::tyres): work of
  /// the lateral tyre forces, integral of RunRow::tyre_power_mps.
  double tyre_work = 0.0;
  /// Electrical work of the motors, J; absent if the vehicle has no stall power.
  std::optional<double> electric_work_j;
};

/// Sum of copper loss and mechanical work, J, for the normalised mass m':
///   P_s energy_electric + F_max energy_mech,   F_max = m/m'                          [paper (66)]
/// P_s is the stall power of one motor (Vehicle::motor_stall_power_w). Absent if it is not known.
std::optional<double> electric_work_j(const Metrics& metrics, const Vehicle& vehicle,
                                      double mass_norm);

/// Computes the metrics of a run from its rows, of which there is at least one. `controller`: that
/// of the run. electric_work_j is left absent.
Metrics metrics_of(const Run& run, const Scenario& scenario, const Controller<double>& controller);

}  // namespace awmr
