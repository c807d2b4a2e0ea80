#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/csv/raw_table.h"

namespace awmr {
namespace {

/// The rows that are kept. Two conditions must hold: in this row or above it, each command (kHeld)
/// has a value; and in this row, at least one column that may have empty cells has a value.
std::vector<std::size_t> rows_that_count(const CsvTable& table, const ColumnSources& sources) {
  const std::size_t rows = table.lines.size();
  std::vector<bool> counts(rows, false);
  std::size_t known = 0;
  for (const ColumnSource& source : sources.found) {
    if (source.column.empty == EmptyCells::kFault || source.indices.empty()) continue;
    const auto column = table.columns.find(source.column.name);
    if (column == table.columns.end()) continue;
    const std::vector<bool>& present = column->second.present;
    for (std::size_t row = 0; row < rows; ++row) {
      if (present.empty() || present[row]) counts[row] = true;
    }
    if (source.column.empty != EmptyCells::kHeld || present.empty()) continue;
    const auto first = std::find(present.begin(), present.end(), true) - present.begin();
    known = std::max(known, static_cast<std::size_t>(first));
  }
  std::vector<std::size_t> kept;
  for (std::size_t row = known; row < rows; ++row) {
    if (counts[row]) kept.push_back(row);
  }
  return kept;
}

template <class Values>
void keep(Values& values, const std::vector<std::size_t>& rows) {
  if (!values.empty()) values = picked(values, rows);
}

/// Text with the number of values of each column that has empty cells: "heading_deg 120, ...".
std::string rates_of(const CsvTable& table) {
  std::string text;
  for (const auto& [name, column] : table.columns) {
    if (column.present.empty()) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name,
                        std::count(column.present.begin(), column.present.end(), true));
  }
  return text;
}

}  // namespace

void drop_rows(CsvTable& table, const ColumnSources& sources) {
  const std::vector<std::size_t> kept = rows_that_count(table, sources);
  const std::size_t before = table.lines.size();
  RowLines lines;
  for (const std::size_t row : kept) lines.push_back(table.lines[row]);
  table.lines = std::move(lines);
  for (auto& [name, column] : table.columns) {
    keep(column.values, kept);
    keep(column.character, kept);
    keep(column.present, kept);
  }
  table.notes.push_back(
      {0, "joined-by-time",
       fmt::format(
           "signals of different rates were joined by time into {} rows; number of values by "
           "column: {}. A command keeps its value until its next value. A measurement is used only "
           "in the rows that have it, a formula only in the rows of its most frequent column. {} "
           "rows without a value, or before the first value of every command, are left out",
           table.lines.size(), rates_of(table), before - table.lines.size())});
}

bool is_void(const CsvTable::Column& column) {
  const std::vector<bool>& present = column.present;
  return !present.empty() && !contains(present, true);
}

void refuse_void_columns(const CsvTable& table, const ColumnSources& sources,
                         std::vector<Fault>& faults) {
  for (const ColumnSource& source : sources.found) {
    if (source.column.empty == EmptyCells::kOptional) continue;
    if (!is_void(table.columns.at(source.column.name))) continue;
    faults.push_back(
        {ErrorCode::kMissing, table.header_place(),
         fmt::format("the column {} has no value in any row; add values, or map another "
                     "column",
                     source.column.name)});
  }
}

}  // namespace awmr
