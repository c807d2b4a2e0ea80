#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/csv_text.h"

namespace awmr {

bool CsvTable::has(std::string_view column) const {
  return parts_.columns.find(column) != parts_.columns.end();
}

std::span<const double> CsvTable::column(std::string_view column) const {
  return parts_.columns.find(column)->second.values;
}

std::vector<double> CsvTable::take(std::string_view column) {
  return std::exchange(parts_.columns.find(column)->second.values, {});
}

const std::vector<bool>& CsvTable::present(std::string_view column) const {
  return parts_.columns.find(column)->second.present;
}

std::string CsvTable::place(std::size_t row, std::string_view column) const {
  const auto found = parts_.columns.find(column);
  const bool is_known = found != parts_.columns.end() && !found->second.character.empty();
  return fmt::format("{}:{}:{}", parts_.file, line(row),
                     is_known ? found->second.character[row] : 1);
}

std::string CsvTable::header_place() const {
  return fmt::format("{}:{}:1", parts_.file, parts_.header_line);
}

std::string finding_file(const CsvTable& table) {
  return std::filesystem::path(table.file()).filename().string();
}

}  // namespace awmr
