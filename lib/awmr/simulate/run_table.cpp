#include "awmr/simulate/run_table.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "awmr/core/csv_text.h"
#include "awmr/simulate/simulate.h"

namespace awmr {
namespace {

std::vector<CsvColumn> run_columns() {
  std::vector<CsvColumn> columns;
  for (const char* name :
       {"t_s", "x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps", "force_left", "force_right",
        "steering_rad", "steering_cmd_rad", "psi_ref_rad", "u_ref_mps"}) {
    columns.push_back({name});
  }
  return columns;
}

Status check_time(const CsvTable& table) {
  const auto t = table.column("t_s");
  const auto back = std::is_sorted_until(t.begin(), t.end());
  if (back == t.end()) return {};
  return input_error(
      ErrorCode::kWrongOrder, table.place(static_cast<std::size_t>(back - t.begin()), "t_s"),
      "the time in this row is smaller than in the row before; simulate the run again");
}

struct Column {
  const char* name;
  double (*value)(const RunRow&);
};

constexpr Column kColumns[] = {
    {"t_s", [](const RunRow& r) { return r.t_s; }},
    {"x_m", [](const RunRow& r) { return r.state.x_m; }},
    {"y_m", [](const RunRow& r) { return r.state.y_m; }},
    {"psi_rad", [](const RunRow& r) { return r.state.psi_rad; }},
    {"u_mps", [](const RunRow& r) { return r.state.u_mps; }},
    {"v_mps", [](const RunRow& r) { return r.state.v_mps; }},
    {"r_radps", [](const RunRow& r) { return r.state.r_radps; }},
    {"force_left", [](const RunRow& r) { return r.force.left; }},
    {"force_right", [](const RunRow& r) { return r.force.right; }},
    {"steering_rad", [](const RunRow& r) { return r.state.steering_rad; }},
    {"steering_cmd_rad", [](const RunRow& r) { return r.steering_command_rad; }},
    {"tau_speed", [](const RunRow& r) { return r.tau_speed; }},
    {"tau_turn", [](const RunRow& r) { return r.tau_turn_m; }},
    {"psi_ref_rad", [](const RunRow& r) { return r.psi_ref_rad; }},
    {"u_ref_mps", [](const RunRow& r) { return r.u_ref_mps; }},
};
constexpr Column kPathColumns[] = {
    {"psi_goal_rad", [](const RunRow& r) { return r.path.psi_goal_rad; }},
    {"cross_track_m", [](const RunRow& r) { return r.path.cross_track_m; }},
    {"target_x_m", [](const RunRow& r) { return r.path.target_m.x_m; }},
    {"target_y_m", [](const RunRow& r) { return r.path.target_m.y_m; }},
    {"leg", [](const RunRow& r) { return static_cast<double>(r.path.leg); }},
};
constexpr Column kClearance[] = {{"clearance_m", [](const RunRow& r) { return r.clearance_m; }}};
constexpr Column kMeasured[] = {
    {"measured_x_m", [](const RunRow& r) { return r.measured_position_m.x_m; }},
    {"measured_y_m", [](const RunRow& r) { return r.measured_position_m.y_m; }},
    {"measured_psi_rad", [](const RunRow& r) { return r.measured.psi_rad; }},
    {"measured_u_mps", [](const RunRow& r) { return r.measured.u_mps; }},
    {"measured_v_mps", [](const RunRow& r) { return r.measured.v_mps; }},
    {"measured_r_radps", [](const RunRow& r) { return r.measured.r_radps; }},
};
constexpr Column kDisturbance[] = {
    {"disturbance_surge", [](const RunRow& r) { return r.disturbance.surge; }},
    {"disturbance_sway", [](const RunRow& r) { return r.disturbance.sway; }},
    {"disturbance_yaw_m", [](const RunRow& r) { return r.disturbance.yaw_m; }},
};

constexpr Column kTyres[] = {{"tyre_power_mps", [](const RunRow& r) { return r.tyre_power_mps; }}};

bool has_path(const Scenario& scenario) {
  return !std::holds_alternative<OpenLoop>(scenario.guidance) &&
         !std::holds_alternative<HeadingSteps>(scenario.guidance);
}

std::vector<Column> columns_of(const Scenario& scenario) {
  std::vector<Column> columns(std::begin(kColumns), std::end(kColumns));
  const auto add = [&](bool wanted, const auto& more) {
    if (wanted) columns.insert(columns.end(), std::begin(more), std::end(more));
  };
  add(has_path(scenario), kPathColumns);
  add(!scenario.obstacles.empty(), kClearance);
  add(scenario.sensors.has_value(), kMeasured);
  add(scenario.disturbance.any(), kDisturbance);
  add(scenario.tyres.has_value(), kTyres);
  return columns;
}

}  // namespace

std::vector<std::pair<std::string_view, double>> named_values(const RunRow& row,
                                                              const Scenario& scenario) {
  std::vector<std::pair<std::string_view, double>> named;
  for (const Column& column : columns_of(scenario)) {
    named.emplace_back(column.name, column.value(row));
  }
  return named;
}

std::string run_csv(const Run& run, const Scenario& scenario) {
  const std::vector<Column> columns = columns_of(scenario);
  std::string text;
  for (const Column& column : columns) {
    text += column.name;
    text += ',';
  }
  text.back() = '\n';
  for (const RunRow& row : run.rows) {
    for (const Column& column : columns) {
      text += format_number(column.value(row));
      text += ',';
    }
    text.back() = '\n';
  }
  return text;
}

Result<CsvTable> read_run(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(CsvTable table, read_csv(path, run_columns()));
  AWMR_RETURN_IF_ERROR(check_time(table));
  return table;
}

Status check_run_text(std::string_view text, const std::string& file) {
  AWMR_ASSIGN_OR_RETURN(const CsvTable table, read_csv_text(text, file, run_columns()));
  return check_time(table);
}

}  // namespace awmr
