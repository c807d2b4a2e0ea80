/// Finds the header of a CSV text, its delimiter and its column names. Private to the library.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/csv/csv_scanner.h"

namespace awmr {

struct CsvHeader {
  std::vector<CsvCell> cells = {};        ///< the cells of the header, as in the text
  std::vector<std::string> names = {};    ///< column names; "" in a quoted name is one "
  std::vector<std::string> samples = {};  ///< the cells of the first row
  int line = 1;
  char delimiter = ',';
  int skipped_lines = 0;    ///< number of lines above the header, comments not counted
  bool is_comment = false;  ///< true: the header is a comment, after a '#'
  /// True: the file has no header. The names are `column_1`, `column_2`, ...; `cells` are the cells
  /// of the first row.
  bool is_positional = false;
};

/// Finds the header and moves `scanner` to the first row. The header is recognised by the names in
/// `columns` and `mappings`; lines of titles above it are skipped. Precondition: `scanner` is at
/// the first byte of the text. `file` names the text in errors. Errors: no header; an unterminated
/// quote, or text after a closing quote; numbers instead of names; JSON or HTML; cells separated by
/// spaces; names that are not UTF-8.
Result<CsvHeader> find_header(CsvScanner& scanner, const std::string& file,
                              std::span<const CsvColumn> columns,
                              std::span<const ColumnMapping> mappings);

/// Returns a note to the user (`csv-format`) if the file does not have the usual format: header in
/// the first line, cells between commas, semicolons or tabs, decimal points.
std::vector<CsvNote> format_notes(const CsvHeader& header, bool has_decimal_commas);

std::string message_of(CsvScanner::Outcome outcome);

}  // namespace awmr
