#include <algorithm>
#include <cmath>

#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

bool always(const Scenario&) { return true; }
bool has_path(const Scenario& scenario) {
  return !std::holds_alternative<OpenLoop>(scenario.guidance) &&
         !std::holds_alternative<HeadingSteps>(scenario.guidance);
}
bool has_obstacles(const Scenario& scenario) { return !scenario.obstacles.empty(); }
bool has_sensors(const Scenario& scenario) { return scenario.sensors.has_value(); }
bool has_disturbance(const Scenario& scenario) { return scenario.disturbance.any(); }
bool has_tyres(const Scenario& scenario) { return scenario.tyres.has_value(); }

struct Column {
  const char* name;
  double (*value)(const RunRow&);
  bool (*is_in)(const Scenario&);  ///< true if a run of the scenario has the column
};

/// All columns of run.csv, in their order.
constexpr Column kRunColumns[] = {
    {"t_s", [](const RunRow& r) { return r.t_s; }, always},
    {"x_m", [](const RunRow& r) { return r.state.x_m; }, always},
    {"y_m", [](const RunRow& r) { return r.state.y_m; }, always},
    {"psi_rad", [](const RunRow& r) { return r.state.psi_rad; }, always},
    {"u_mps", [](const RunRow& r) { return r.state.u_mps; }, always},
    {"v_mps", [](const RunRow& r) { return r.state.v_mps; }, always},
    {"r_radps", [](const RunRow& r) { return r.state.r_radps; }, always},
    {"force_left", [](const RunRow& r) { return r.force.left; }, always},
    {"force_right", [](const RunRow& r) { return r.force.right; }, always},
    {"steering_rad", [](const RunRow& r) { return r.state.steering_rad; }, always},
    {"steering_cmd_rad", [](const RunRow& r) { return r.steering_command_rad; }, always},
    {"tau_speed", [](const RunRow& r) { return r.tau_speed; }, always},
    {"tau_turn", [](const RunRow& r) { return r.tau_turn_m; }, always},
    {"psi_ref_rad", [](const RunRow& r) { return r.psi_ref_rad; }, always},
    {"u_ref_mps", [](const RunRow& r) { return r.u_ref_mps; }, always},
    {"psi_goal_rad", [](const RunRow& r) { return r.path.psi_goal_rad; }, has_path},
    {"cross_track_m", [](const RunRow& r) { return r.path.cross_track_m; }, has_path},
    {"target_x_m", [](const RunRow& r) { return r.path.target_m.x_m; }, has_path},
    {"target_y_m", [](const RunRow& r) { return r.path.target_m.y_m; }, has_path},
    {"leg", [](const RunRow& r) { return static_cast<double>(r.path.leg); }, has_path},
    {"clearance_m", [](const RunRow& r) { return r.clearance_m; }, has_obstacles},
    {"measured_x_m", [](const RunRow& r) { return r.measured_position_m.x_m; }, has_sensors},
    {"measured_y_m", [](const RunRow& r) { return r.measured_position_m.y_m; }, has_sensors},
    {"measured_psi_rad", [](const RunRow& r) { return r.measured.psi_rad; }, has_sensors},
    {"measured_u_mps", [](const RunRow& r) { return r.measured.u_mps; }, has_sensors},
    {"measured_v_mps", [](const RunRow& r) { return r.measured.v_mps; }, has_sensors},
    {"measured_r_radps", [](const RunRow& r) { return r.measured.r_radps; }, has_sensors},
    {"disturbance_surge", [](const RunRow& r) { return r.disturbance.surge; }, has_disturbance},
    {"disturbance_sway", [](const RunRow& r) { return r.disturbance.sway; }, has_disturbance},
    {"disturbance_yaw_m", [](const RunRow& r) { return r.disturbance.yaw_m; }, has_disturbance},
    {"tyre_power_mps", [](const RunRow& r) { return r.tyre_power_mps; }, has_tyres},
};

}  // namespace

bool is_finite(const RunRow& row) {
  return std::all_of(std::begin(kRunColumns), std::end(kRunColumns),
                     [&](const Column& column) { return std::isfinite(column.value(row)); });
}

std::vector<std::pair<std::string_view, double>> named_values(const RunRow& row,
                                                              const Scenario& scenario) {
  std::vector<std::pair<std::string_view, double>> named;
  for (const Column& column : kRunColumns) {
    if (column.is_in(scenario)) named.emplace_back(column.name, column.value(row));
  }
  return named;
}

}  // namespace awmr
