/// vehicle.json (`awmr.vehicle/1`): what is known of the vehicle before any trial.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "awmr/core/interval.h"
#include "awmr/core/result.h"

namespace awmr {

struct Vehicle {
  std::string name;
  double mass_kg = 0.0;           ///< m, > 0
  double length_m = 0.0;          ///< b of the box formula, > 0
  double width_m = 0.0;           ///< a of the box formula, > 0
  double front_axle_m = 0.0;      ///< l_f, > 0
  double half_track_m = 0.0;      ///< d, > 0
  Interval wheel_force;           ///< F' of one wheel over F_max: -1 <= min < max, 0 < max <= 1
  double steering_max_deg = 0.0;  ///< (0, 90)
  double steering_max_rate_degps = 0.0;    ///< > 0
  double steering_time_constant_s = 0.0;   ///< T, > 0
  double sample_time_s = 0.0;              ///< T_s, > 0
  std::optional<double> yaw_inertia_kgm2;  ///< measured Iz; absent: the box formula
  std::optional<double> sway_alpha;        ///< a_s of g2, s/m
  Interval surge_beta_range{0.0, 1.0};     ///< where b1 may lie, 0 <= lo < hi
  Interval yaw_beta_range{0.0, 4.0};       ///< where b3 may lie, 0 <= lo < hi

  /// Iz = m (a^2 + b^2)/12 for a uniform box, or the measured value.                    [paper
  /// (65)]
  double inertia_kgm2() const;
};

/// Errors: as read_json_file; unknown, missing or impossible values.
Result<Vehicle> read_vehicle(const std::filesystem::path& path);

}  // namespace awmr
