#include "awmr/core/csv_columns.h"

#include <map>

#include "awmr/core/csv_cell.h"
#include "awmr/core/raw_table.h"
#include "awmr/core/time_column.h"

namespace awmr {

std::vector<CsvUsedColumn> used_columns(const ColumnSources& sources,
                                        std::span<const std::string> header) {
  std::vector<CsvUsedColumn> used;
  std::map<std::size_t, std::size_t> place;
  for (const ColumnSource& source : sources.found) {
    for (const std::size_t index : source.indices) {
      const auto [found, is_new] = place.emplace(index, used.size());
      if (is_new) {
        used.push_back(
            {.index = index, .name = source.expression ? header[index] : source.column.name});
      }
      if (source.time && source.time->is_date) used[found->second].is_date = true;
      if (source.column.empty == EmptyCells::kFault) used[found->second].may_be_empty = false;
    }
  }
  return used;
}

std::optional<double> csv_value(std::string_view text, const CsvUsedColumn& column) {
  text = trimmed(text);
  if (column.may_be_empty && text.empty()) return kEmptyCell;
  if (column.is_date) return seconds_of_date(text);
  const auto value = number_from_text(text);
  return value ? std::optional(*value) : std::nullopt;
}

}  // namespace awmr
