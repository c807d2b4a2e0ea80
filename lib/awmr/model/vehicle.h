/// Vehicle data that are known before any trial; read from vehicle.json by vehicle_file.h.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include "awmr/core/interval.h"
#include "awmr/core/name_table.h"
#include "awmr/model/allocation_form.h"

namespace awmr {

/// Drive of the vehicle: which wheels are driven, and whether the front wheels steer.
enum class Drive {
  kFourWheel,     ///< four driven wheels, the front ones steered, as in the paper
  kDifferential,  ///< no steering (d_r = 0): turned only by left and right wheel forces
  kFrontWheel,    ///< only the front wheels are driven, and steered
};
inline constexpr NameTable<Drive, 3> kDriveNames{{{"four_wheel", Drive::kFourWheel},
                                                  {"differential", Drive::kDifferential},
                                                  {"front_wheel", Drive::kFrontWheel}}};

inline constexpr NameTable<AllocationForm, 2> kAllocationFormNames{
    {{"exact", AllocationForm::kExact}, {"paper", AllocationForm::kPaper}}};

/// Errors of the vehicle's sensors: standard deviations of the noise, latencies, and correlation
/// times of the noise (0: independent readings). Absent: not known.
struct SensorQuality {
  std::optional<double> heading_deg = {};             ///< deg, >= 0
  std::optional<double> yaw_rate_degps = {};          ///< deg/s, >= 0
  std::optional<double> speed_mps = {};               ///< m/s, >= 0
  std::optional<double> position_m = {};              ///< m, >= 0
  std::optional<double> heading_latency_s = {};       ///< s, >= 0
  std::optional<double> yaw_rate_latency_s = {};      ///< s, >= 0
  std::optional<double> speed_latency_s = {};         ///< s, >= 0
  std::optional<double> position_latency_s = {};      ///< s, >= 0
  std::optional<double> heading_correlation_s = {};   ///< s, >= 0
  std::optional<double> yaw_rate_correlation_s = {};  ///< s, >= 0
  std::optional<double> speed_correlation_s = {};     ///< s, >= 0
  bool operator==(const SensorQuality&) const = default;
};

/// Data measured on the vehicle or taken from its data sheets.
struct Vehicle {
  std::string name;
  double mass_kg = 0.0;                    ///< m, kg, > 0: ready to drive, with batteries
  double length_m = 0.0;                   ///< b of the box formula, m, > 0: along the body's x
  double width_m = 0.0;                    ///< a of the box formula, m, > 0: along the body's y
  Drive drive = Drive::kFourWheel;         ///< without steering, the steering_ fields are 0
  double front_axle_m = 0.0;               ///< l_f, m, > 0: centre of gravity to front axle
  double half_track_m = 0.0;               ///< d, m, > 0: centre line to the middle of a wheel
  Interval wheel_force;                    ///< range of F' of one wheel: -1 <= lo <= 0 < hi <= 1
  double steering_max_deg = 0.0;           ///< d_max, deg, in (0, 90): stop, the same either side
  double steering_max_rate_degps = 0.0;    ///< d_rate_max, deg/s, > 0: the servo's maximum rate
  double steering_time_constant_s = 0.0;   ///< T, s, > 0: the servo's first-order lag
  double sample_time_s = 0.0;              ///< T_s, s, > 0: between two steps of the controller
  std::optional<double> yaw_inertia_kgm2;  ///< Iz, kg m^2, > 0, measured; absent: the box formula
  std::optional<double> sway_alpha;        ///< a_s of g2, s/m, > 0; absent: from a log, or assumed
  Interval surge_beta_range{0.0, 2.5};     ///< range of b1 in fits, 0 <= lo < hi
  Interval yaw_beta_range{0.0, 4.0};       ///< range of b3 in fits, 0 <= lo < hi

  /// Form of the allocation of the simulated controller; that of the firmware is always exact.
  AllocationForm allocation = AllocationForm::kExact;
  /// Errors of the sensors. Gains are tuned and runs are simulated with them
  /// (simulate/conditions.h).
  SensorQuality sensors = {};
  /// Time constant of the first-order lag from the motors' command to their force, s, >= 0. Tuning
  /// and simulation use it, and a fit filters the logged commands with it. Absent: no lag, unless a
  /// log identifies one.
  std::optional<double> motor_time_constant_s;
  /// k_e, s/m, >= 0: decrease of a motor's force, divided by F_max, per m/s at its wheel, from the
  /// motor's data sheet. Absent: no back-EMF, unless a log identifies it.
  std::optional<double> back_emf_s_per_m;
  /// P_s, W, > 0: power of one motor under full voltage at standstill, where all of it becomes
  /// heat; absent: electrical work is not reported in joules.
  std::optional<double> motor_stall_power_w;
  /// Largest yaw rate for which the yaw resistance is known, deg/s, > 0. Absent: the largest yaw
  /// rate of the turning trials and fitted logs.
  std::optional<double> yaw_rate_max_degps;

  /// For columns of awmr, by name: the column or formula in this vehicle's log files that gives
  /// their values (core/column_mapping.h).
  std::map<std::string, std::string> columns = {};

  bool has_steering() const { return drive != Drive::kDifferential; }
  /// n, the number of driven wheels. Straight ahead, tau_speed = n F'.
  int driven_wheels() const { return drive == Drive::kFrontWheel ? 2 : 4; }

  /// Yaw inertia about the centre of gravity, kg m^2: the measured Iz if available, else that of a
  /// uniform box,
  ///   Iz = m (a^2 + b^2)/12                                                           [paper (65)]
  double inertia_kgm2() const;
};

/// True if mass, length, width, l_f and d have the values of the paper's vehicle. The paper's claims
/// are about this vehicle, so they are shown only for it.
bool is_vehicle_of_paper(const Vehicle& vehicle);

/// Range of the force of one wheel, divided by F_max: the range of the commands, reduced at both
/// ends by the motors' dead zone.
inline Interval forces_beyond_dead_zone(const Interval& wheel_force, double dead_zone) {
  return {std::min(wheel_force.lo + dead_zone, 0.0), std::max(wheel_force.hi - dead_zone, 0.0)};
}

}  // namespace awmr
