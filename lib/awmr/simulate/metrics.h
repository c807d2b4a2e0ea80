/// Metrics of one run: the columns of comparison.csv, and the basis of the cost in tuning. A metric
/// without a meaning in the run's scenario is absent, never 0.
#pragma once

#include <optional>

#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// The metrics of one run.
struct Metrics {
  /// True if the vehicle completed its task without touching an obstacle. Task of heading steps:
  /// the heading settles in every step; of waypoints: all are reached; of a line: its end is
  /// reached; of a timed path: in the second half of the run, the vehicle stays within the
  /// tolerance of the moving point.
  bool completed = true;
  /// Settling time, s: time from a heading step until the heading error |e| stays within 2 % of the
  /// size of the step (at least 0.5 deg); the longest time of all steps. Absent if the heading did
  /// not settle in a step.
  std::optional<double> settling_time_s;
  /// Overshoot: largest angle by which the heading exceeds a commanded heading in the direction of
  /// its step, deg, >= 0.
  std::optional<double> overshoot_deg;
  std::optional<double> heading_iae_degs;  ///< integral of the heading error |e|, deg s
  /// integral of t |e|, with the time t since the step (for tuning)
  std::optional<double> heading_itae_degs2;
  std::optional<double> cross_track_rms_m;  ///< RMS distance from the current leg, line or path
  double path_length_m = 0.0;               ///< length of the driven path
  /// Speed drop, m/s, >= 0: commanded speed minus the smallest speed after the vehicle first
  /// reached 99.9 % of the commanded speed. Absent if it never did, or if the commanded speed is
  /// not constant (slow-down, avoidance, timed path).
  std::optional<double> speed_drop_mps;
  /// integral of t |u_d - u|, speed error weighted with time (for tuning)
  double speed_itae_m_s = 0.0;
  /// Largest sideslip angle |atan2(v, |u|)|, deg, at speeds above 0.05 m/s, forward or backward.
  double sideslip_max_deg = 0.0;
  double yaw_rate_max_degps = 0.0;  ///< largest |r|, deg/s
  /// Sum of the absolute changes of the commands d_r/d_max, F'L/F'max and F'R/F'max, divided by the
  /// duration of the run, 1/s.
  double control_variation = 0.0;
  double control_effort = 0.0;  ///< mean of F'L^2 + F'R^2 + (d_r/d_max)^2 over the run
  /// Smallest distance from the vehicle to an obstacle, m; < 0 if they overlapped. If the vehicle
  /// avoids obstacles, its shape is a circle, else a point. Absent without obstacles.
  std::optional<double> clearance_min_m;
  /// Time, s, at which the vehicle reached the last waypoint or the end of the line. Absent if it
  /// did not, if it missed a waypoint, or if it overlapped an obstacle.
  std::optional<double> finish_time_s;

  /// Positive mechanical work of the motors, divided by F_max, m; braking recovers no energy:
  ///   integral of sum_i max(0, F'_i w_i)
  /// F'_i: force of wheel i, which is RunRow::acting less dead zone and back-EMF; w_i: speed of the
  /// wheel in its rolling direction.
  double energy_mech = 0.0;
  /// Copper loss of the motors, divided by the loss of one motor at F_max, s:
  ///   integral of sum_i F'_i^2
  /// F'_i as in energy_mech.
  double energy_electric = 0.0;
  /// Time with a motor command at a limit of its force or the steering at its stop, s.
  double saturation_s = 0.0;
  /// sum of the absolute changes of the actual steering angle d_r
  double steering_travel_deg = 0.0;
  double steering_rate_rms_degps = 0.0;  ///< RMS rate of the commanded steering angle (for tuning)
  /// Work that wears the tyres, divided by F_max, m. 3-DOF model: work against yaw resistance and
  /// tyre scrub, the integral of g3(r) r plus RunRow::tyre_power_mps. Vehicle on tyres
  /// (Scenario::tyres): work of the lateral tyre forces, the integral of RunRow::tyre_power_mps.
  double tyre_work = 0.0;
  /// Electrical work of the motors, J. Absent if the stall power of the motors is not known.
  std::optional<double> electric_work_j;
};

/// Computes the sum of copper loss and mechanical work, J, for the normalised mass m':
///   P_s energy_electric + F_max energy_mech,   F_max = m/m'                          [paper (66)]
/// P_s: stall power of one motor (Vehicle::motor_stall_power_w); m: mass. Absent if P_s is not
/// known.
std::optional<double> electric_work_j(const Metrics& metrics, const Vehicle& vehicle,
                                      double mass_norm);

/// Computes the metrics of a run from its rows, without electric_work_j. Precondition: there is at
/// least one row, and `controller` is that of the run.
Metrics metrics_of(const Run& run, const Scenario& scenario, const Controller<double>& controller);

}  // namespace awmr
