/// The metrics by name, in the order of comparison.csv. Private to this folder.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "awmr/simulate/metrics.h"

namespace awmr {

struct MetricColumn {
  std::string_view name;
  std::string_view unit;
  std::optional<double> (*value)(const Metrics&);
  /// > 0: lower is better and the ranking counts it; the floor is what is too small to matter, in
  /// the metric's unit (ranking.h). 0: not ranked.
  double ranking_floor = 0.0;
};

inline constexpr std::array<MetricColumn, 11> kMetricColumns = {{
    {"settling_time_s", "s",
     [](const Metrics& m) -> std::optional<double> { return m.settling_time_s; }, 0.1},
    {"overshoot_deg", "deg",
     [](const Metrics& m) -> std::optional<double> { return m.overshoot_deg; }, 0.5},
    {"heading_iae_degs", "deg s",
     [](const Metrics& m) -> std::optional<double> { return m.heading_iae_degs; }, 1.0},
    {"cross_track_rms_m", "m",
     [](const Metrics& m) -> std::optional<double> { return m.cross_track_rms_m; }, 0.05},
    {"path_length_m", "m",
     [](const Metrics& m) -> std::optional<double> { return m.path_length_m; }},
    {"speed_drop_mps", "m/s",
     [](const Metrics& m) -> std::optional<double> { return m.speed_drop_mps; }, 0.02},
    {"sideslip_max_deg", "deg",
     [](const Metrics& m) -> std::optional<double> { return m.sideslip_max_deg; }, 0.5},
    {"yaw_rate_max_degps", "deg/s",
     [](const Metrics& m) -> std::optional<double> { return m.yaw_rate_max_degps; }},
    {"control_variation", "1/s",
     [](const Metrics& m) -> std::optional<double> { return m.control_variation; }, 0.05},
    {"clearance_min_m", "m",
     [](const Metrics& m) -> std::optional<double> { return m.clearance_min_m; }},
    {"finish_time_s", "s",
     [](const Metrics& m) -> std::optional<double> { return m.finish_time_s; }, 0.1},
}};

}  // namespace awmr
