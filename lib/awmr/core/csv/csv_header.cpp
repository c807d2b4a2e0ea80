#include "awmr/core/csv/csv_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "awmr/core/csv/column_sources.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/csv/foreign_format.h"
#include "awmr/core/option_text.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

using Outcome = CsvScanner::Outcome;

/// Text of a cell. In a quoted cell, each pair of quotes is replaced by one quote.
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
  int found = 0;  ///< number of requested columns among the cells of the header
};

/// Finds the delimiter of the scanner's next line: the character that splits it into cells with the
/// most names of requested columns; among equals, the character that makes the most cells.
Delimiter delimiter_of(const CsvScanner& scanner, const std::set<std::string>& wanted) {
  int best = 0;
  Delimiter chosen;
  for (const char delimiter : {',', ';', '\t', '|'}) {
    const std::vector<CsvCell> cells = scanner.peek_cells(delimiter);
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
  return chosen;
}

/// Takes the last comment above the first row as the header, because some programs write the header
/// after a '#'. Returns false, without a change, if this comment has another number of cells than
/// the first row, or no requested column.
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
  if (!are_records || names.size() != first_row.size()) return false;
  header.cells = std::move(names);
  header.line = scanner.comment_line();
  for (CsvCell& cell : header.cells) cell.line = header.line;
  header.delimiter = chosen.character;
  scanner.set_delimiter(header.delimiter);
  return header.is_comment = true;
}

/// Names of the columns of a file without a header: `column_1`, `column_2`, ...
constexpr std::string_view kPositionName = "column_";

bool is_position(const std::string& name) {
  if (!name.starts_with(kPositionName) || name.size() == kPositionName.size()) return false;
  const std::string_view digits = std::string_view(name).substr(kPositionName.size());
  return std::all_of(digits.begin(), digits.end(), is_digit);
}

bool is_number(const CsvCell& cell, bool may_have_comma) {
  std::string text = name_of(cell);
  if (may_have_comma) std::replace(text.begin(), text.end(), ',', '.');
  return number_from_text(text).has_value();
}

/// For a file without a header: if columns are requested by position (`column_1`) and the first
/// line has only numbers, takes this line as the first row. Otherwise returns false, without a
/// change.
bool take_positions(CsvScanner& scanner, const std::set<std::string>& wanted, CsvHeader& header) {
  if (std::none_of(wanted.begin(), wanted.end(), is_position)) return false;
  for (const char delimiter : {';', '\t', '|', ','}) {
    CsvScanner row = scanner;
    row.set_delimiter(delimiter);
    std::vector<CsvCell> cells;
    const bool is_record = row.next(cells) == Outcome::kRecord;
    const bool are_numbers = std::all_of(cells.begin(), cells.end(), [&](const CsvCell& cell) {
      return is_number(cell, delimiter != ',');
    });
    if (!is_record || cells.size() < 2 || !are_numbers) continue;
    scanner.set_delimiter(header.delimiter = delimiter);
    header.cells = std::move(cells);
    for (std::size_t i = 0; i < header.cells.size(); ++i) {
      header.names.push_back(fmt::format("{}{}", kPositionName, i + 1));
    }
    return header.is_positional = true;
  }
  return false;
}

/// True for a line that a program adds above a table: the first line of a PuTTY log, or Excel's
/// `sep=;`.
bool is_mark(std::string_view line) {
  std::string_view text = trimmed(line);
  if (text.starts_with("=~=~=")) return true;
  if (text.starts_with('"') && text.ends_with('"') && text.size() > 1) {
    text = text.substr(1, text.size() - 2);
  }
  constexpr std::size_t kSeparatorMark = 5;  // sep=;
  return text.size() == kSeparatorMark && (text.starts_with("sep=") || text.starts_with("SEP="));
}

bool has_number(const std::vector<CsvCell>& cells, char delimiter) {
  return std::any_of(cells.begin(), cells.end(),
                     [&](const CsvCell& cell) { return is_number(cell, delimiter != ','); });
}

/// True if the scanner's next line is a header. Either at least two of its cells are names of
/// requested columns. Or it has at least two cells and no number, and the row below it has as many
/// cells and at least one number.
bool is_above_rows(CsvScanner scanner, const Delimiter& chosen) {
  const std::vector<CsvCell> names = scanner.peek_cells(chosen.character);
  if (chosen.found >= 2) return true;
  if (names.size() < 2 || has_number(names, chosen.character)) return false;
  scanner.skip_line();
  scanner.peek_line();
  const std::vector<CsvCell> row = scanner.peek_cells(chosen.character);
  return row.size() == names.size() && has_number(row, chosen.character);
}

void skip_marks(CsvScanner& scanner, CsvHeader& header) {
  while (is_mark(scanner.peek_line())) {
    scanner.skip_line();
    ++header.skipped_lines;
  }
}

/// Skips up to 20 lines of titles above the header. Titles have fewer cells than the header. If the
/// first line contains the name of a requested column or a number, it is not a title, and nothing
/// is skipped.
void skip_titles(CsvScanner& scanner, const std::set<std::string>& wanted, CsvHeader& header) {
  constexpr int kMaxTitleLines = 20;
  CsvScanner ahead = scanner;
  std::size_t most_cells = 0;
  for (int skipped = 0; skipped <= kMaxTitleLines && !ahead.peek_line().empty(); ++skipped) {
    const Delimiter chosen = delimiter_of(ahead, wanted);
    const std::vector<CsvCell> cells = ahead.peek_cells(chosen.character);
    if (skipped == 0 && (chosen.found > 0 || has_number(cells, chosen.character))) return;
    const bool may_be_header = most_cells == 1 || chosen.found >= 2;
    if (skipped > 0 && cells.size() > most_cells && may_be_header && is_above_rows(ahead, chosen)) {
      scanner = ahead;
      header.skipped_lines += skipped;
      return;
    }
    most_cells = std::max(most_cells, cells.size());
    ahead.skip_line();
  }
}

/// Checks the column names. Errors: a name is not UTF-8.
Status check_names(const CsvHeader& header, const std::string& file) {
  for (const CsvCell& cell : header.cells) {
    if (is_utf8(cell.text)) continue;
    return input_error(
        ErrorCode::kBrokenFile, fmt::format("{}:{}:{}", file, cell.line, cell.character),
        fmt::format("the column's name \"{}\" is not UTF-8 (Latin-1?); save the file "
                    "as UTF-8",
                    shortened(cell.text, 40)));
  }
  return {};
}

Status take_first_line(CsvScanner& scanner, const std::string& file, CsvHeader& header) {
  scanner.set_delimiter(header.delimiter);
  const Outcome outcome = scanner.next(header.cells);
  if (outcome == Outcome::kEnd) {
    return input_error(ErrorCode::kMissing, file,
                       "the file has no header row; add a first row with the columns' names");
  }
  if (outcome != Outcome::kRecord) {
    const CsvCell& cell = header.cells.back();
    return input_error(ErrorCode::kBrokenFile,
                       fmt::format("{}:{}:{}", file, cell.line, cell.character),
                       message_of(outcome));
  }
  const bool are_numbers = std::all_of(header.cells.begin(), header.cells.end(),
                                       [](const CsvCell& cell) { return is_number(cell, false); });
  if (!are_numbers) return {};
  return input_error(
      ErrorCode::kMissing, fmt::format("{}:{}:1", file, header.line),
      fmt::format("this row holds numbers; expected the columns' names: add them, or map the "
                  "columns by their position, as in {}",
                  option_text("column t_s=column_1")));
}

}  // namespace

Result<CsvHeader> find_header(CsvScanner& scanner, const std::string& file,
                              std::span<const CsvColumn> columns,
                              std::span<const ColumnMapping> mappings) {
  const std::set<std::string> wanted = wanted_names(columns, mappings);
  CsvHeader header;
  skip_marks(scanner, header);
  AWMR_RETURN_IF_ERROR(check_format(scanner, file));
  skip_titles(scanner, wanted, header);
  scanner.peek_line();
  header.line = scanner.line();
  AWMR_RETURN_IF_ERROR(check_spaces(scanner, file, wanted));
  const Delimiter chosen = delimiter_of(scanner, wanted);
  header.delimiter = chosen.character;
  const bool is_found = chosen.found == 0 && (take_comment(scanner, wanted, header) ||
                                              take_positions(scanner, wanted, header));
  if (!is_found) AWMR_RETURN_IF_ERROR(take_first_line(scanner, file, header));
  AWMR_RETURN_IF_ERROR(check_names(header, file));
  if (!header.is_positional) {
    for (const CsvCell& cell : header.cells) header.names.push_back(name_of(cell));
  }
  for (const CsvCell& cell : scanner.peek_cells(header.delimiter)) {
    header.samples.emplace_back(cell.text);
  }
  return header;
}

std::vector<CsvNote> format_notes(const CsvHeader& header, bool has_decimal_commas) {
  const bool is_usual = header.delimiter != '|' && header.skipped_lines == 0;
  if (is_usual && !has_decimal_commas && !header.is_comment && !header.is_positional) return {};
  const std::string_view between = header.delimiter == ','    ? "commas"
                                   : header.delimiter == ';'  ? "semicolons"
                                   : header.delimiter == '\t' ? "tabs"
                                                              : "vertical bars";
  const std::string skipped =
      header.skipped_lines == 0
          ? ""
          : fmt::format(", without the {} line{} above the header", header.skipped_lines,
                        header.skipped_lines == 1 ? "" : "s");
  return {{header.line, "csv-format",
           fmt::format("read with cells between {}{}{}{}", between,
                       has_decimal_commas ? ", decimal commas" : "",
                       header.is_comment      ? ", column names after #"
                       : header.is_positional ? ", the columns by position (no header)"
                                              : "",
                       skipped)}};
}

std::string message_of(CsvScanner::Outcome outcome) {
  return outcome == Outcome::kOpenQuote
             ? "the quotation mark that opens this cell is not closed; add the closing mark"
             : "there is text between the closing quote of this cell and the delimiter; write a "
               "quote inside a quoted cell twice";
}

}  // namespace awmr
