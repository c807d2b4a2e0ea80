/// The header of a CSV text: which line it is, what parts its cells and what they are called. Private
/// to the library.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/csv_scanner.h"

namespace awmr {

struct CsvHeader {
  std::vector<CsvCell> cells = {};        ///< the names, as they stand in the text
  std::vector<std::string> names = {};    ///< by column, doubled quotes made single
  std::vector<std::string> samples = {};  ///< the cells of the first row
  int line = 1;
  char delimiter = ',';
  int skipped_lines = 0;    ///< above it, that are neither header nor comments
  bool is_comment = false;  ///< the names stand behind a '#'
  bool is_positional =
      false;            ///< there is none: `column_1`, ... are its names, `cells` the first row's
  bool is_cut = false;  ///< the whole text was looked at: a longer one may say something else
};

/// Finds the header and leaves `scanner`, which begins at the text's first byte, at the first row.
/// `file` names the text in errors. Errors: no header, a quote that is not closed or has text behind
/// it, numbers in place of names, JSON or HTML, cells between spaces, names that are not UTF-8.
Result<CsvHeader> find_header(CsvScanner& scanner, const std::string& file,
                              std::span<const CsvColumn> columns,
                              std::span<const ColumnMapping> mappings);

/// The note that says how the file was taken, where there was something to find out.
std::vector<CsvNote> format_notes(const CsvHeader& header, bool has_decimal_commas);

/// What is wrong with a record: a quote that is not closed, or text behind one that is.
std::string message_of(CsvScanner::Outcome outcome);

}  // namespace awmr
