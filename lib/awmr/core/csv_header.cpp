#include "awmr/core/csv_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv_cell.h"

namespace awmr {
namespace {

using Outcome = CsvScanner::Outcome;

/// The text of a cell with its doubled quotes made single.
std::string name_of(const CsvCell& cell) {
  std::string name;
  for (std::size_t i = 0; i < cell.text.size(); ++i) {
    name += cell.text[i];
    if (cell.is_quoted && cell.text.substr(i, 2) == "\"\"") ++i;
  }
  return name;
}

struct Delimiter {
  char character = ',';
  int found = 0;        ///< columns asked for that it parts off
  bool is_cut = false;  ///< as in CsvHeader
};

/// The delimiter that finds most of the columns asked for, then the one that makes most cells.
Delimiter delimiter_of(const CsvScanner& scanner, const std::set<std::string>& wanted) {
  int best = 0;
  Delimiter chosen;
  bool is_cut = false;
  for (const char delimiter : {',', ';', '\t'}) {
    CsvScanner copy = scanner;
    copy.set_delimiter(delimiter);
    std::vector<CsvCell> cells;
    copy.next(cells);  // up to a fault, if there is one
    is_cut = is_cut || copy.ran_out();
    const auto found =
        static_cast<int>(std::count_if(cells.begin(), cells.end(), [&](const CsvCell& cell) {
          return wanted.count(name_of(cell)) != 0;
        }));
    const int points = 10000 * found + static_cast<int>(std::min<std::size_t>(cells.size(), 9999));
    if (points > best) {
      best = points;
      chosen = {.character = delimiter, .found = found};
    }
  }
  chosen.is_cut = is_cut;
  return chosen;
}

/// Some programs write the names behind a '#': the last comment above the first row, where it has as
/// many cells as that and some of the columns asked for.
bool take_comment(CsvScanner& scanner, const std::set<std::string>& wanted, CsvHeader& header) {
  CsvScanner comment(scanner.comment());
  const Delimiter chosen = delimiter_of(comment, wanted);
  if (chosen.found == 0) return false;
  CsvScanner row = scanner;
  row.set_delimiter(chosen.character);
  comment.set_delimiter(chosen.character);
  std::vector<CsvCell> names;
  std::vector<CsvCell> first_row;
  const bool are_records =
      comment.next(names) == Outcome::kRecord && row.next(first_row) == Outcome::kRecord;
  header.is_cut = header.is_cut || row.ran_out();
  if (!are_records || names.size() != first_row.size()) return false;
  header.cells = std::move(names);
  header.line = scanner.comment_line();
  for (CsvCell& cell : header.cells) cell.line = header.line;
  header.delimiter = chosen.character;
  scanner.set_delimiter(header.delimiter);
  return header.is_comment = true;
}

Status take_first_line(CsvScanner& scanner, const std::string& file, CsvHeader& header) {
  scanner.set_delimiter(header.delimiter);
  const Outcome outcome = scanner.next(header.cells);
  if (outcome == Outcome::kEnd) {
    return input_error(file, "the file has no header row; expected the columns' names");
  }
  if (outcome != Outcome::kRecord) {
    const CsvCell& cell = header.cells.back();
    return input_error(fmt::format("{}:{}:{}", file, cell.line, cell.character),
                       message_of(outcome));
  }
  const auto is_number = [](const CsvCell& cell) {
    return number_from_text(name_of(cell)).has_value();
  };
  if (!std::all_of(header.cells.begin(), header.cells.end(), is_number)) return {};
  return input_error(fmt::format("{}:{}:1", file, header.line),
                     "this row holds numbers; expected the columns' names");
}

/// The texts of the first row.
void take_samples(CsvScanner scanner, CsvHeader& header) {
  std::vector<CsvCell> cells;
  scanner.next(cells);
  header.is_cut = header.is_cut || scanner.ran_out();
  header.samples.reserve(cells.size());
  for (const CsvCell& cell : cells) header.samples.emplace_back(cell.text);
}

}  // namespace

Result<CsvHeader> find_header(CsvScanner& scanner, const std::string& file,
                              std::span<const CsvColumn> columns,
                              std::span<const ColumnMapping> mappings) {
  const std::set<std::string> wanted = wanted_names(columns, mappings);
  CsvHeader header;
  scanner.peek_line();
  header.line = scanner.line();
  const Delimiter chosen = delimiter_of(scanner, wanted);
  header.delimiter = chosen.character;
  header.is_cut = chosen.is_cut;
  if (chosen.found > 0 || !take_comment(scanner, wanted, header)) {
    AWMR_RETURN_IF_ERROR(take_first_line(scanner, file, header));
  }
  for (const CsvCell& cell : header.cells) header.names.push_back(name_of(cell));
  take_samples(scanner, header);
  return header;
}

std::vector<CsvNote> format_notes(const CsvHeader& header, bool has_decimal_commas) {
  if (!has_decimal_commas && !header.is_comment) return {};
  const std::string_view between = header.delimiter == ','   ? "commas"
                                   : header.delimiter == ';' ? "semicolons"
                                                             : "tabs";
  return {{header.line, "csv-format",
           fmt::format("read with cells between {}{}{}", between,
                       has_decimal_commas ? ", decimal commas" : "",
                       header.is_comment ? ", the columns' names behind #" : "")}};
}

std::string message_of(CsvScanner::Outcome outcome) {
  return outcome == Outcome::kOpenQuote
             ? "this quote is not closed"
             : "there is text between the closing quote of this cell and the delimiter; double a "
               "quote inside a quoted cell";
}

}  // namespace awmr
