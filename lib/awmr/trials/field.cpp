#include "awmr/trials/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/option_text.h"
#include "awmr/trials/trial_columns.h"

namespace awmr {
namespace {

constexpr std::size_t kShortestField = 30;

std::vector<double> values_of(const CsvTable& table, std::string_view name) {
  if (!table.has(name)) return {};
  const std::span<const double> column = table.column(name);
  return {column.begin(), column.end()};
}

const CsvColumn kFieldColumns[] = {
    {"t_s"}, {"field_ahead"}, {"field_left"}, {"yaw_rate_radps", false}};

/// Checks the column mappings. Errors: a mapping to a column that a field record does not have.
Status check_names(const std::vector<ColumnMapping>& mappings) {
  std::vector<Fault> faults;
  for (const ColumnMapping& mapping : mappings) {
    const auto* known = std::ranges::find(kFieldColumns, mapping.name, &CsvColumn::name);
    if (known != std::end(kFieldColumns)) continue;
    faults.push_back({ErrorCode::kUnknownName,
                      fmt::format("{} {}", option_text("column"), mapping.name),
                      "unknown column; a field record has t_s, field_ahead, field_left and "
                      "yaw_rate_radps"});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace

Result<FieldRecord> read_field(const std::filesystem::path& path,
                               const std::vector<ColumnMapping>& mappings) {
  AWMR_RETURN_IF_ERROR(check_names(mappings));
  AWMR_ASSIGN_OR_RETURN(const CsvTable table, read_csv(path, kFieldColumns, mappings));
  AWMR_RETURN_IF_ERROR(check_mappings({.columns = mappings}, table.mapped, {{path}}));
  FieldRecord record{.file = path.filename().string(),
                     .t_s = values_of(table, "t_s"),
                     .ahead = values_of(table, "field_ahead"),
                     .left = values_of(table, "field_left"),
                     .yaw_rate_radps = values_of(table, "yaw_rate_radps")};
  std::vector<Fault> faults;
  for (std::size_t i = 1; i < record.t_s.size() && faults.size() < kMaxFaults; ++i) {
    if (record.t_s[i] > record.t_s[i - 1]) continue;
    faults.push_back(
        {ErrorCode::kWrongOrder, table.place(i, "t_s"),
         fmt::format("found {} after {}: time must increase", record.t_s[i], record.t_s[i - 1])});
  }
  if (table.rows() < kShortestField) {
    faults.push_back({ErrorCode::kTooFewData, table.header_place(),
                      fmt::format("the field record has {} rows; at least {} are needed",
                                  table.rows(), kShortestField)});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return record;
}

}  // namespace awmr
