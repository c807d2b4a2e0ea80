/// CSV in: header row, unit in the column name; comma, semicolon or tab (detected), `#` comment
/// lines, CRLF, a BOM and quoted fields. Columns are found by name, extra ones ignored.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/column_mapping.h"
#include "awmr/core/result.h"
#include "awmr/core/row_lines.h"

namespace awmr {

/// What an empty cell means in a table whose columns have values at times of their own.
enum class EmptyCells {
  kFault,   ///< it is one: a value belongs into every row
  kHeld,    ///< a command: the previous value still holds
  kAbsent,  ///< a measurement: there was none in this row
  /// Of a table with a row per run: this run has none. Any number of rows may be without; nothing is kept
  /// from the row before, and no row is left out for it. Empty in all of them, the column is absent, also
  /// where it is required.
  kOptional,
};

struct CsvColumn {
  std::string name;
  bool required = true;
  EmptyCells empty = EmptyCells::kFault;
};

/// What a reader has to tell of how it took a file; never silent, never a fault.
struct CsvNote {
  int line = 0;  ///< 0: the file as a whole
  std::string code;
  std::string message;
};

/// Finds again where a cell stands in the file.
class CellPlaces;

/// The numeric columns that were asked for, and where each cell stood.
class CsvTable {
 public:
  struct Column {
    std::vector<double> values;
    std::vector<int> character;      ///< column in the file, from 1, by row; empty: see `cell`
    std::vector<bool> present = {};  ///< by row: has a value of its own; empty: all have
    std::optional<std::size_t> cell = {};  ///< of a row, from 0, whose place `places` finds
  };
  struct Parts {
    std::string file;
    int header_line = 1;
    RowLines lines = {};
    std::map<std::string, Column, std::less<>> columns = {};
    std::vector<CsvNote> notes = {};
    std::vector<std::size_t> mapped = {};
    double clock_s = 0.0;
    std::shared_ptr<const CellPlaces> places = {};  ///< null: where `character` is not known, 1
  };
  /// Precondition: every column has a value for every line.
  explicit CsvTable(Parts parts) : parts_(std::move(parts)) {}

  const std::string& file() const { return parts_.file; }
  std::size_t rows() const { return parts_.lines.size(); }
  bool has(std::string_view column) const;
  /// Values by row. Precondition: has(column).
  std::span<const double> column(std::string_view column) const;
  /// The same, moved out of the table, whose column is empty then. Precondition: has(column).
  std::vector<double> take(std::string_view column);
  /// By row: the value was written there, not held from a row before. Empty: all were.
  /// Precondition: has(column).
  const std::vector<bool>& present(std::string_view column) const;
  /// Line in the file, from 1.
  int line(std::size_t row) const { return parts_.lines[row]; }
  /// `FILE:LINE:COLUMN` of a cell; a column that is absent gives `FILE:LINE:1`.
  std::string place(std::size_t row, std::string_view column) const;
  /// `FILE:LINE:1` of the header.
  std::string header_place() const;
  const std::vector<CsvNote>& notes() const { return parts_.notes; }
  /// What a clock's time had taken off so that t_s counts from the first row, s.
  double clock_s() const { return parts_.clock_s; }
  /// The mappings that gave a column: indices into those that the table was read with.
  const std::vector<std::size_t>& mapped() const { return parts_.mapped; }

 private:
  Parts parts_;
};

/// Reads the columns asked for. Where at least one of them that is kHeld or kAbsent is empty in a quarter
/// of its rows or more, the file holds signals of different rates: the empty cells of columns that may have some
/// mean what EmptyCells says, and rows without a value of any column are left out.
/// Every fault of the file at once: missing required or duplicate columns, ragged rows, cells that
/// are empty, not numbers, NaN or infinite, an unterminated quote, no rows, a formula whose value
/// is infinite or NaN.
Result<CsvTable> read_csv(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                          std::span<const ColumnMapping> mappings = {});

/// CSV out: numbers in the shortest form that reads back the same.
std::string format_number(double value);

}  // namespace awmr
