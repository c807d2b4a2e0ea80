/// Table of the metrics: names, units and weights, in the order of comparison.csv. Private to
/// compare/.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "awmr/simulate/metrics.h"

namespace awmr {

struct MetricColumn {
  std::string_view name;  ///< name in comparison.csv and comparison.json
  /// Column heading in the terminal's table, at most 7 characters; empty: no column.
  std::string_view head;
  std::string_view unit;
  std::variant<double Metrics::*, std::optional<double> Metrics::*> figure;
  /// Floor: differences up to this value do not matter, in the metric's unit, >= 0 (scoring.h).
  /// Above 0: the metric can be used to rank modes, and lower values are better. 0: the metric is
  /// never used to rank.
  double ranking_floor = 0.0;
  double default_weight = 0.0;  ///< weight in the ranking, unless the user sets it

  bool can_rank() const { return ranking_floor > 0.0; }
  /// Returns the value of the metric; absent if the metric does not apply to the run.
  std::optional<double> value(const Metrics& metrics) const {
    return std::visit([&](auto member) { return std::optional<double>(metrics.*member); }, figure);
  }
  void set(Metrics& metrics, double value) const {
    std::visit([&](auto member) { metrics.*member = value; }, figure);
  }
};

/// All metrics. Heading and cross-track error, settling and finishing time, speed drop, mechanical
/// work and tyre work have the default weight 1 in the ranking. All other metrics have the weight
/// 0. For example, the sideslip follows from the geometry of the turn. The control variation is
/// nearly 0 in some modes, so its ratios mean little.
inline constexpr std::array<MetricColumn, 17> kMetricColumns = {{
    {"settling_time_s", "settle", "s", &Metrics::settling_time_s, 0.1, 1.0},
    {"overshoot_deg", "overs.", "deg", &Metrics::overshoot_deg, 0.5, 0.0},
    {"heading_iae_degs", "IAE", "deg s", &Metrics::heading_iae_degs, 1.0, 1.0},
    {"cross_track_rms_m", "x-track", "m", &Metrics::cross_track_rms_m, 0.05, 1.0},
    {"path_length_m", "", "m", &Metrics::path_length_m},
    {"speed_drop_mps", "drop", "m/s", &Metrics::speed_drop_mps, 0.02, 1.0},
    {"sideslip_max_deg", "slip", "deg", &Metrics::sideslip_max_deg, 0.5, 0.0},
    {"yaw_rate_max_degps", "yaw", "deg/s", &Metrics::yaw_rate_max_degps},
    {"control_variation", "var.", "1/s", &Metrics::control_variation, 0.05, 0.0},
    {"clearance_min_m", "clear", "m", &Metrics::clearance_min_m},
    {"finish_time_s", "finish", "s", &Metrics::finish_time_s, 0.1, 1.0},
    {"energy_mech", "energy", "m", &Metrics::energy_mech, 0.05, 1.0},
    {"energy_electric", "", "s", &Metrics::energy_electric, 0.5, 0.0},
    {"saturation_s", "", "s", &Metrics::saturation_s, 0.1, 0.0},
    {"steering_travel_deg", "", "deg", &Metrics::steering_travel_deg, 5.0, 0.0},
    {"tyre_work", "tyres", "m", &Metrics::tyre_work, 0.01, 1.0},
    {"electric_work_j", "", "J", &Metrics::electric_work_j, 1.0, 0.0},
}};

}  // namespace awmr
