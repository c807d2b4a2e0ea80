#include "awmr/core/csv_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv_cell.h"
#include "awmr/core/option_text.h"

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

/// `column_1`, `column_2`, ...: what the columns of a file without a header are called.
constexpr std::string_view kPositionName = "column_";

bool is_position(const std::string& name) {
  if (!name.starts_with(kPositionName) || name.size() == kPositionName.size()) return false;
  const std::string_view digits = std::string_view(name).substr(kPositionName.size());
  return std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_number(const CsvCell& cell, bool may_have_comma) {
  std::string text = name_of(cell);
  if (may_have_comma) std::replace(text.begin(), text.end(), ',', '.');
  return number_from_text(text).has_value();
}

/// Where columns are asked for by their position and the first line holds numbers, it is a row already.
bool take_positions(CsvScanner& scanner, const std::set<std::string>& wanted, CsvHeader& header) {
  if (std::none_of(wanted.begin(), wanted.end(), is_position)) return false;
  for (const char delimiter : {';', '\t', ','}) {
    CsvScanner row = scanner;
    row.set_delimiter(delimiter);
    std::vector<CsvCell> cells;
    const bool is_record = row.next(cells) == Outcome::kRecord;
    header.is_cut = header.is_cut || row.ran_out();
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
  const bool are_numbers = std::all_of(header.cells.begin(), header.cells.end(),
                                       [](const CsvCell& cell) { return is_number(cell, false); });
  if (!are_numbers) return {};
  return input_error(
      fmt::format("{}:{}:1", file, header.line),
      fmt::format("this row holds numbers; expected the columns' names: add them, or map the "
                  "columns by their position, as in {}",
                  option_text("column t_s=column_1")));
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
  const bool is_found = chosen.found == 0 && (take_comment(scanner, wanted, header) ||
                                              take_positions(scanner, wanted, header));
  if (!is_found) AWMR_RETURN_IF_ERROR(take_first_line(scanner, file, header));
  if (!header.is_positional) {
    for (const CsvCell& cell : header.cells) header.names.push_back(name_of(cell));
  }
  take_samples(scanner, header);
  return header;
}

std::vector<CsvNote> format_notes(const CsvHeader& header, bool has_decimal_commas) {
  if (!has_decimal_commas && !header.is_comment && !header.is_positional) return {};
  const std::string_view between = header.delimiter == ','   ? "commas"
                                   : header.delimiter == ';' ? "semicolons"
                                                             : "tabs";
  return {
      {header.line, "csv-format",
       fmt::format("read with cells between {}{}{}", between,
                   has_decimal_commas ? ", decimal commas" : "",
                   header.is_comment      ? ", the columns' names behind #"
                   : header.is_positional ? ", the columns by their position, as there is no header"
                                          : "")}};
}

std::string message_of(CsvScanner::Outcome outcome) {
  return outcome == Outcome::kOpenQuote
             ? "this quote is not closed"
             : "there is text between the closing quote of this cell and the delimiter; double a "
               "quote inside a quoted cell";
}

}  // namespace awmr
