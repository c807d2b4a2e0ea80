/// CSV in: header row, unit in the column name; comma, semicolon or tab (detected), `#` comment
/// lines, CRLF, a BOM and quoted fields. Columns are found by name, extra ones ignored.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

struct CsvColumn {
  std::string name;
  bool required = true;
};

/// `NAME=SOURCE[*SCALE][+OFFSET]`: column NAME is the file's SOURCE, times SCALE, plus OFFSET.
struct ColumnMapping {
  std::string name;
  std::string source;
  double scale = 1.0;
  double offset = 0.0;
};

/// A SOURCE may be quoted, and must be where it holds '*' or '+'; after a scale or a quoted SOURCE,
/// `-OFFSET` is taken as well. Errors: not of that form, a scale or offset that is no finite
/// number, a scale of 0.
Result<ColumnMapping> parse_column_mapping(std::string_view text);

/// The numeric columns that were asked for, and where each cell stood.
class CsvTable {
 public:
  const std::string& file() const { return file_; }
  std::size_t rows() const { return lines_.size(); }
  bool has(std::string_view column) const;
  /// Values by row. Precondition: has(column).
  std::span<const double> column(std::string_view column) const;
  /// Line in the file, from 1.
  int line(std::size_t row) const { return lines_[row]; }
  /// `FILE:LINE:COLUMN` of a cell; a column that is absent gives `FILE:LINE:1`.
  std::string place(std::size_t row, std::string_view column) const;
  /// `FILE:LINE:1` of the header.
  std::string header_place() const;

 private:
  friend class CsvParser;
  struct Column {
    std::vector<double> values;
    std::vector<int> character;  ///< column in the file, from 1, by row
  };
  std::string file_;
  int header_line_ = 1;
  std::vector<int> lines_;
  std::map<std::string, Column, std::less<>> columns_;
};

/// Reads the columns asked for. Every fault of the file at once: missing required or duplicate
/// columns, ragged rows, cells that are empty, not numbers, NaN or infinite, an unterminated quote,
/// no rows.
Result<CsvTable> read_csv(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                          std::span<const ColumnMapping> mappings = {});

/// CSV out: numbers in the shortest form that reads back the same.
std::string format_number(double value);

}  // namespace awmr
