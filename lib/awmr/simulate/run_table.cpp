#include "awmr/simulate/run_table.h"

#include <algorithm>
#include <vector>

#include "awmr/core/csv_text.h"

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

}  // namespace

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
