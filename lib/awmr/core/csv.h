/// Reads CSV files as tables of numbers. Columns are found by their names in the header; other
/// columns are ignored. The delimiter (comma, semicolon, tab or vertical bar) is detected. Comment
/// lines (`#`), CRLF, a byte order mark and quoted cells are accepted.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/column_mapping.h"
#include "awmr/core/result.h"

namespace awmr {

/// Meaning of an empty cell in a requested column.
enum class EmptyCells {
  kFault,   ///< a fault: every row needs a value
  kHeld,    ///< a command in a log with signals of different rates: the previous value still holds
  kAbsent,  ///< a measurement in a log with signals of different rates: none was made in this row
  /// For a table with one row per run: an empty cell means that the run has no value. The value of
  /// the row before is not repeated, and no row is dropped. A column that is empty in all rows
  /// counts as absent.
  kOptional,
};

/// A requested column.
struct CsvColumn {
  std::string name;
  bool required = true;  ///< true: a missing column is a fault
  EmptyCells empty = EmptyCells::kFault;
};

/// Note on how a file was interpreted, for the user.
struct CsvNote {
  int line = 0;      ///< line that the note is about; 0: the whole file
  std::string code;  ///< "csv-format", ...: apps/awmr/FINDINGS.md lists the codes
  std::string message;
};

/// Line number in the file of each row of a table. To save memory, rows on consecutive lines are
/// stored as one entry.
class RowLines {
 public:
  std::size_t size() const { return rows_; }
  bool empty() const { return rows_ == 0; }
  /// Line in the file, from 1. Precondition: row < size().
  int operator[](std::size_t row) const {
    const auto next = std::upper_bound(runs_.begin(), runs_.end(), row,
                                       [](std::size_t r, const Run& run) { return r < run.row; });
    const Run& run = *(next - 1);
    return run.line + static_cast<int>(row - run.row);
  }
  void push_back(int line) { append(line, 1); }
  /// Adds `rows` rows on consecutive lines.
  void append(int first_line, std::size_t rows) {
    if (rows == 0) return;
    const bool goes_on =
        !runs_.empty() &&
        first_line == runs_.back().line + static_cast<int>(rows_ - runs_.back().row);
    if (!goes_on) runs_.push_back({rows_, first_line});
    rows_ += rows;
  }

 private:
  /// Rows on consecutive lines.
  struct Run {
    std::size_t row;  ///< first row
    int line;         ///< its line
  };
  std::vector<Run> runs_ = {};
  std::size_t rows_ = 0;
};

/// Table of the requested columns: their numbers, and the place of each cell in the file.
struct CsvTable {
  struct Column {
    std::vector<double> values;
    /// By row: position of the cell in its line, in characters from 1; empty: unknown.
    std::vector<int> character;
    std::vector<bool> present = {};  ///< by row: true if the file has a value; empty: in all rows
  };
  std::string file;
  int header_line = 1;
  RowLines lines = {};  ///< by row
  /// By name; each column has a value for every row.
  std::map<std::string, Column, std::less<>> columns = {};
  std::vector<CsvNote> notes = {};
  /// Indices of the mappings that were used, in the list of mappings given to the reader.
  std::vector<std::size_t> mapped = {};
  /// Clock time of the first row, s, such as seconds since 1970. It was subtracted from the times
  /// t_s. 0 if the file has no clock time.
  double clock_s = 0.0;

  std::size_t rows() const { return lines.size(); }
  bool has(std::string_view column) const { return columns.find(column) != columns.end(); }
  /// Values by row. Precondition: has(column).
  std::span<const double> column(std::string_view column) const;
  /// As column(), but moves the values out of the table: its column is empty afterwards.
  /// Precondition: has(column).
  std::vector<double> take(std::string_view column);
  /// By row: true if the file has a value. In the other rows, the table repeats the previous value,
  /// or, at the start, the first value. Empty: the file has a value in every row. Precondition:
  /// has(column).
  const std::vector<bool>& present(std::string_view column) const;
  /// Line in the file, from 1.
  int line(std::size_t row) const { return lines[row]; }
  /// Place of a cell, `FILE:LINE:COLUMN`, where COLUMN counts characters. `FILE:LINE:1` if the
  /// table lacks the column or its position is unknown.
  std::string place(std::size_t row, std::string_view column) const;
  /// `FILE:LINE:1` of the header.
  std::string header_place() const;
};

/// Reads the requested columns. A log can have signals of different rates in one table, with many
/// empty cells. A file counts as such a log if at least a quarter of the cells of a command (kHeld)
/// or a measurement (kAbsent) are empty. In such a log:
///   - An empty cell of a command repeats the previous value. An empty cell of a measurement means
///     that nothing was measured in this row.
///   - A row without any value in kHeld, kAbsent and kOptional columns is dropped. So are the first
///     rows, until every command has had a value.
/// In other files, empty cells are faults, except in kOptional columns. All faults of the file are
/// reported at once: a missing required column; a duplicate column; no rows; a row with another
/// number of cells than the header; a cell that is empty, not a number, NaN or infinite; an
/// unterminated quote; a formula whose value is infinite or NaN.
Result<CsvTable> read_csv(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                          std::span<const ColumnMapping> mappings = {});

/// As read_csv(), but parses `bytes`, the content of a file. `file`: name of the file in errors.
Result<CsvTable> read_csv_text(std::string_view bytes, const std::string& file,
                               std::span<const CsvColumn> columns,
                               std::span<const ColumnMapping> mappings = {});

/// Header and first rows of a table, as text.
struct CsvHead {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< cells, by row
  char delimiter = ',';
};

/// Reads the header and up to `most_rows` rows as text. The header is recognised by the names in
/// `columns` and `mappings`; lines of titles above it are skipped. Errors: those of find_header()
/// (csv_header.h).
Result<CsvHead> csv_head(std::string_view bytes, const std::string& file,
                         std::span<const CsvColumn> columns,
                         std::span<const ColumnMapping> mappings, std::size_t most_rows);

/// Name of the table's file without its directory, for findings: so outputs do not depend on where
/// the file is.
std::string finding_file(const CsvTable& table);

/// The shortest decimal text that reads back to the same number.
std::string format_number(double value);

}  // namespace awmr
