#include "awmr/core/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "awmr/core/csv/column_sources.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/csv/csv_header.h"
#include "awmr/core/csv/csv_scanner.h"
#include "awmr/core/csv/decimal_comma.h"
#include "awmr/core/csv/foreign_format.h"
#include "awmr/core/csv/raw_table.h"
#include "awmr/core/input_file.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

/// A column of the file from which at least one requested column is computed.
struct UsedColumn {
  std::size_t index;         ///< index in the header
  std::string name;          ///< name in messages
  bool may_be_empty = true;  ///< true: all requested columns computed from it permit empty cells
  bool is_date = false;      ///< its cells are dates of ISO 8601
};

/// The columns of the file from which the requested columns are computed, each once.
std::vector<UsedColumn> used_columns(const ColumnSources& sources, const CsvHeader& header) {
  std::vector<UsedColumn> used;
  for (const ColumnSource& source : sources.found) {
    for (const std::size_t index : source.indices) {
      auto column = std::find_if(used.begin(), used.end(),
                                 [&](const UsedColumn& other) { return other.index == index; });
      if (column == used.end()) {
        const std::string& name = source.expression ? header.names[index] : source.column.name;
        column = used.insert(column, {.index = index, .name = name});
      }
      if (source.time && source.time->is_date) column->is_date = true;
      if (source.column.empty == EmptyCells::kFault) column->may_be_empty = false;
    }
  }
  return used;
}

/// Parses the header and the rows of a text. Collects up to kMaxFaults faults.
class CsvParser {
 public:
  CsvParser(std::string file, std::string_view text) : text_(text), scanner_(text) {
    raw_.file = std::move(file);
  }

  Result<CsvHead> head(std::span<const CsvColumn> columns, std::span<const ColumnMapping> mappings,
                       std::size_t most_rows);
  Result<CsvTable> parse(std::span<const CsvColumn> columns,
                         std::span<const ColumnMapping> mappings);

 private:
  void fault(ErrorCode code, int line, int character, std::string message) {
    faults_.push_back(
        {code, fmt::format("{}:{}:{}", raw_.file, line, character), std::move(message)});
  }

  ColumnSources find_sources(std::span<const CsvColumn> columns,
                             std::span<const ColumnMapping> mappings);
  void reserve();
  void check_commas();
  bool scan();
  bool read_row();
  bool has_decimal_commas() const;
  void report_ragged();
  void read_cells();
  double value_of(const CsvCell& cell, const UsedColumn& used);

  std::string_view text_;
  CsvScanner scanner_;
  std::vector<CsvCell> cells_ = {};
  CsvHeader header_ = {};
  std::vector<UsedColumn> used_ = {};
  std::vector<Fault> faults_ = {};
  DecimalCommas commas_ = {};
  RawTable raw_ = {};
};

Result<CsvHead> CsvParser::head(std::span<const CsvColumn> columns,
                                std::span<const ColumnMapping> mappings, std::size_t most_rows) {
  AWMR_ASSIGN_OR_RETURN(header_, find_header(scanner_, raw_.file, columns, mappings));
  CsvHead head{.names = header_.names, .rows = {}, .delimiter = header_.delimiter};
  while (head.rows.size() < most_rows && scan()) {
    std::vector<std::string>& row = head.rows.emplace_back();
    for (const CsvCell& cell : cells_) row.emplace_back(cell.text);
  }
  return head;
}

Result<CsvTable> CsvParser::parse(std::span<const CsvColumn> columns,
                                  std::span<const ColumnMapping> mappings) {
  AWMR_ASSIGN_OR_RETURN(header_, find_header(scanner_, raw_.file, columns, mappings));
  raw_.header_line = header_.line;
  raw_.columns.resize(header_.names.size());
  ColumnSources sources = find_sources(columns, mappings);
  used_ = used_columns(sources, header_);
  reserve();
  while (faults_.size() < kMaxFaults && read_row()) {
  }
  check_commas();
  raw_.notes = format_notes(header_, commas_.comma.has_value());
  return table_of(std::move(raw_), std::move(sources), mappings, std::move(faults_));
}

/// Reserves memory for all rows. Their number is estimated from the length of the first row.
void CsvParser::reserve() {
  std::size_t row_bytes = 1;
  for (const std::string& sample : header_.samples) row_bytes += sample.size() + 1;
  for (const UsedColumn& used : used_) {
    raw_.columns[used.index].value.reserve(text_.size() / row_bytes);
    raw_.columns[used.index].character.reserve(text_.size() / row_bytes);
  }
}

/// Reads the next record (row) into `cells_`. Returns false at the end of the text, and after a
/// quote that is not closed. After any other fault, returns true with `cells_` empty.
bool CsvParser::scan() {
  const CsvScanner::Outcome outcome = scanner_.next(cells_);
  if (outcome == CsvScanner::Outcome::kRecord) return true;
  if (outcome == CsvScanner::Outcome::kEnd) return false;
  fault(ErrorCode::kBrokenFile, cells_.back().line, cells_.back().character, message_of(outcome));
  if (outcome == CsvScanner::Outcome::kOpenQuote) return false;
  scanner_.skip_line();
  cells_.clear();
  return true;
}

ColumnSources CsvParser::find_sources(std::span<const CsvColumn> columns,
                                      std::span<const ColumnMapping> mappings) {
  ColumnSources sources =
      find_columns(header_.names, header_.samples, columns, mappings, raw_.file);
  for (HeaderFault& found : sources.faults) {
    const bool placed = found.cell.has_value();
    fault(found.code, placed ? header_.cells[*found.cell].line : header_.line,
          placed ? header_.cells[*found.cell].character : 1, std::move(found.message));
  }
  return sources;
}

bool CsvParser::read_row() {
  if (!scan()) return false;
  if (cells_.empty()) return true;
  if (cells_.size() != header_.names.size()) {
    report_ragged();
  } else {
    read_cells();
  }
  return true;
}

/// True if decimal commas probably split numbers in this row into too many cells: the delimiter is
/// a comma, the row has more cells than the header, and all cells are whole numbers.
bool CsvParser::has_decimal_commas() const {
  if (header_.delimiter != ',' || cells_.size() <= header_.names.size()) return false;
  const auto is_whole = [](const CsvCell& cell) {
    const std::size_t sign = cell.text.starts_with('-') || cell.text.starts_with('+') ? 1 : 0;
    return cell.text.size() > sign &&
           std::all_of(cell.text.begin() + static_cast<std::ptrdiff_t>(sign), cell.text.end(),
                       is_digit);
  };
  return std::all_of(cells_.begin(), cells_.end(), is_whole);
}

void CsvParser::report_ragged() {
  const CsvCell& cell =
      cells_.size() > header_.names.size() ? cells_[header_.names.size()] : cells_.back();
  std::string message = fmt::format("this row has {} cells, but the header has {}", cells_.size(),
                                    header_.names.size());
  if (has_decimal_commas()) {
    message +=
        ": these commas look like decimal commas; write numbers with a point, or separate the "
        "cells by semicolons";
  } else if (cells_.size() < header_.names.size() && cells_.back().text.end() == text_.end()) {
    message += "; the file ends inside this row: delete it";
  }
  fault(ErrorCode::kBrokenFile, cell.line, cell.character, std::move(message));
}

/// Value of a cell. Returns kEmptyCell for an empty cell that is permitted, and kFaultyCell after a
/// fault (both in raw_table.h).
double CsvParser::value_of(const CsvCell& cell, const UsedColumn& used) {
  if (used.may_be_empty && cell.text.empty()) return kEmptyCell;
  if (used.is_date) {
    if (const auto seconds = seconds_of_date(cell.text)) return *seconds;
    fault(ErrorCode::kWrongType, cell.line, cell.character,
          fmt::format("column {}: expected a date like 2026-01-31T12:34:56.789Z, as in the first "
                      "row; found \"{}\"",
                      used.name, shortened(cell.text, 40)));
    return kFaultyCell;
  }
  const auto value = cell.number ? *cell.number : number_from_text(cell.text);
  if (value) {
    if (header_.delimiter != ',') note_point(cell, commas_);
    return *value;
  }
  if (header_.delimiter != ',') {
    if (const auto with_comma = number_with_comma(cell, commas_)) return *with_comma;
  }
  fault(cell.text.empty() ? ErrorCode::kMissing : ErrorCode::kWrongType, cell.line, cell.character,
        fmt::format("column {}: {}", used.name, value.error()));
  return kFaultyCell;
}

/// Adds a fault if it is unclear whether the commas in the file's numbers are decimal commas or
/// thousands separators, or if other numbers have a decimal point.
void CsvParser::check_commas() {
  if (const auto wrong = fault_of(commas_)) {
    fault(ErrorCode::kAmbiguous, commas_.comma->line, commas_.comma->character, *wrong);
  }
}

void CsvParser::read_cells() {
  raw_.lines.push_back(cells_.front().line);
  for (const UsedColumn& used : used_) {
    const CsvCell& cell = cells_[used.index];
    raw_.columns[used.index].value.push_back(value_of(cell, used));
    raw_.columns[used.index].character.push_back(cell.character);
  }
}

}  // namespace

Result<CsvTable> read_csv_text(std::string_view bytes, const std::string& file,
                               std::span<const CsvColumn> columns,
                               std::span<const ColumnMapping> mappings) {
  AWMR_ASSIGN_OR_RETURN(const std::string_view text, text_of(bytes, file));
  return CsvParser(file, text).parse(columns, mappings);
}

Result<CsvHead> csv_head(std::string_view bytes, const std::string& file,
                         std::span<const CsvColumn> columns,
                         std::span<const ColumnMapping> mappings, std::size_t most_rows) {
  AWMR_ASSIGN_OR_RETURN(const std::string_view text, text_of(bytes, file));
  return CsvParser(file, text).head(columns, mappings, most_rows);
}

Result<CsvTable> read_csv(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                          std::span<const ColumnMapping> mappings) {
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
  return read_csv_text(bytes, path.string(), columns, mappings);
}

std::span<const double> CsvTable::column(std::string_view column) const {
  return columns.find(column)->second.values;
}

std::vector<double> CsvTable::take(std::string_view column) {
  return std::exchange(columns.find(column)->second.values, {});
}

const std::vector<bool>& CsvTable::present(std::string_view column) const {
  return columns.find(column)->second.present;
}

std::string CsvTable::place(std::size_t row, std::string_view column) const {
  const auto found = columns.find(column);
  const bool is_known = found != columns.end() && !found->second.character.empty();
  return fmt::format("{}:{}:{}", file, line(row), is_known ? found->second.character[row] : 1);
}

std::string CsvTable::header_place() const { return fmt::format("{}:{}:1", file, header_line); }

std::string finding_file(const CsvTable& table) {
  return std::filesystem::path(table.file).filename().string();
}

}  // namespace awmr
