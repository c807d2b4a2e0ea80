#include <fmt/format.h>

#include <filesystem>

#include "awmr/core/csv.h"
#include "awmr/core/csv_text.h"

namespace awmr {

bool CsvTable::has(std::string_view column) const {
  return columns_.find(column) != columns_.end();
}

std::span<const double> CsvTable::column(std::string_view column) const {
  return columns_.find(column)->second.values;
}

std::string CsvTable::place(std::size_t row, std::string_view column) const {
  const auto found = columns_.find(column);
  const int character = found == columns_.end() ? 1 : found->second.character[row];
  return fmt::format("{}:{}:{}", file_, lines_[row], character);
}

std::string CsvTable::header_place() const { return fmt::format("{}:{}:1", file_, header_line_); }

std::string finding_file(const CsvTable& table) {
  return std::filesystem::path(table.file()).filename().string();
}

}  // namespace awmr
