/// Finds the header of a CSV text: its line, its delimiter and its column names. Private to the
/// library.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/csv_scanner.h"

namespace awmr {

struct CsvHeader {
  std::vector<CsvCell> cells = {};        ///< the names, as in the text
  std::vector<std::string> names = {};    ///< by column, doubled quotes replaced by single ones
  std::vector<std::string> samples = {};  ///< the cells of the first row
  int line = 1;
  char delimiter = ',';
  int skipped_lines = 0;    ///< lines above it that are neither header nor comments
  bool is_comment = false;  ///< the names follow a '#'
  /// No header: the names are `column_1`, ..., `cells` are the first row's.
  bool is_positional = false;
};

/// Finds the header and leaves `scanner` at the first row. `scanner` starts at the text's first
/// byte. `file` names the text in errors. Errors: no header; an unterminated quote or text behind a
/// quote; numbers instead of names; JSON or HTML; cells separated by spaces; names that are not
/// UTF-8.
Result<CsvHeader> find_header(CsvScanner& scanner, const std::string& file,
                              std::span<const CsvColumn> columns,
                              std::span<const ColumnMapping> mappings);

/// Notes on how the file was interpreted, where that is not obvious.
std::vector<CsvNote> format_notes(const CsvHeader& header, bool has_decimal_commas);

/// Fault text for a record: an unterminated quote, or text behind a closing quote.
std::string message_of(CsvScanner::Outcome outcome);

}  // namespace awmr
