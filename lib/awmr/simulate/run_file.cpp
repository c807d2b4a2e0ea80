#include "awmr/simulate/run_file.h"

#include <algorithm>
#include <limits>

#include "awmr/control/yaw_mode.h"
#include "awmr/core/csv.h"
#include "awmr/core/file.h"
#include "awmr/core/files/hash.h"
#include "awmr/core/json/json.h"
#include "awmr/model/findings_json.h"
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

constexpr std::string_view kRunSchema = "awmr.run/1";

void describe_run(JsonObject& json) {
  json.schema(kRunSchema);
  read_provenance(json);
  json.string("csv_sha256");
  json.optional_string("scenario");
  json.optional_string("mode");
  json.optional_string("plant");
  for (const char* key : {"rows", "substeps", "missed_waypoints", "position_resets"}) {
    json.optional_integer(key, 0, std::numeric_limits<int>::max());
  }
  json.optional_string("end");
  json.optional_boolean("completed");
  for (const char* key : {"metrics", "last_row"}) {
    auto values = json.optional_object(key);
    if (!values) continue;
    for (const std::string& name : values->keys()) values->nullable_number(name);
  }
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

std::string run_csv(const Run& run, const Scenario& scenario) {
  std::string text;
  for (const auto& [name, value] : named_values(run.rows.front(), scenario)) {
    text += name;
    text += ',';
  }
  text.back() = '\n';
  for (const RunRow& row : run.rows) {
    for (const auto& [name, value] : named_values(row, scenario)) {
      text += format_number(value);
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

std::filesystem::path run_side_path(const std::filesystem::path& csv) {
  std::filesystem::path side = csv;
  side += ".json";
  return side;
}

std::string run_side_text(std::string_view csv, const Provenance& provenance,
                          const std::string& figures, const std::vector<Finding>& findings) {
  Json json = output_document(kRunSchema, provenance);
  json["csv_sha256"] = sha256_hex(csv);
  if (!figures.empty()) json.update(Json::parse(figures));
  return with_findings(to_text(json), findings);
}

Status check_run_side(const std::filesystem::path& side) {
  AWMR_ASSIGN_OR_RETURN(const bool exists, regular_file_exists(side));
  if (!exists) return {};
  const auto json = read_json_file(side);
  if (json && json->is_object() && json->value("schema", Json()) == kRunSchema) return {};
  return input_error(
      ErrorCode::kWouldOverwrite, side.string(),
      "this file exists and was not written by simulate; the run's data would overwrite "
      "it. Give another output, or move this file");
}

std::string run_schema() {
  return json_schema_text(kRunSchema, "Origin and metrics of a simulated run", describe_run);
}

}  // namespace awmr
