#include "awmr/core/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv_cell.h"
#include "awmr/core/csv_scanner.h"
#include "awmr/core/csv_text.h"
#include "awmr/core/decimal_comma.h"
#include "awmr/core/input_file.h"
#include "awmr/core/raw_table.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The text of a cell with its doubled quotes made single.
std::string name_of(const CsvCell& cell) {
  std::string name;
  for (std::size_t i = 0; i < cell.text.size(); ++i) {
    name += cell.text[i];
    if (cell.is_quoted && cell.text.substr(i, 2) == "\"\"") ++i;
  }
  return name;
}

/// Header, then rows, gathering faults until there are too many to be of use.
class CsvParser {
 public:
  CsvParser(std::string file, std::string_view bytes, std::span<const CsvColumn> columns,
            std::span<const ColumnMapping> mappings)
      : scanner_(bytes), columns_(columns), mappings_(mappings) {
    raw_.file = std::move(file);
  }

  Result<CsvHead> head(std::size_t most_rows) {
    if (!read_header_cells()) return input_errors(std::move(faults_));
    CsvHead head{.names = {}, .rows = {}, .delimiter = delimiter_};
    for (const CsvCell& cell : header_cells_) head.names.push_back(name_of(cell));
    while (head.rows.size() < most_rows && scan(scanner_)) {
      std::vector<std::string>& row = head.rows.emplace_back();
      for (const CsvCell& cell : cells_) row.emplace_back(cell.text);
    }
    return head;
  }

  Result<CsvTable> parse() {
    if (!read_header()) return input_errors(std::move(faults_));
    while (faults_.size() < kMaxFaults && read_row()) {
    }
    note_format();
    return table_of(std::move(raw_), std::move(sources_), mappings_, std::move(faults_));
  }

 private:
  /// A column of the file that is read.
  struct Used {
    std::size_t index;
    std::string name;      ///< as errors call it
    bool may_be_empty;     ///< for all that is made from it
    bool is_date = false;  ///< a date of ISO 8601
  };

  struct Delimiter {
    char character = ',';
    int found = 0;  ///< columns asked for that it parts off
  };

  void fault(int line, int character, std::string message) {
    faults_.push_back({fmt::format("{}:{}:{}", raw_.file, line, character), std::move(message)});
  }

  bool read_header();
  bool read_header_cells();
  bool take_comment_as_header();
  Delimiter delimiter_of(const CsvScanner& scanner) const;
  std::vector<std::string> samples() const;
  void use_columns();
  void note_format();
  bool scan(CsvScanner& scanner);
  bool read_row();
  void report_ragged();
  void read_cells();
  double value_of(const CsvCell& cell, const Used& used);

  CsvScanner scanner_;
  std::span<const CsvColumn> columns_;
  std::span<const ColumnMapping> mappings_;
  std::vector<CsvCell> cells_;
  std::vector<CsvCell> header_cells_;
  std::vector<std::string> header_;
  ColumnSources sources_;
  std::vector<Used> used_;
  std::vector<Fault> faults_;
  char delimiter_ = ',';
  bool header_is_comment_ = false;
  DecimalCommas commas_;
  RawTable raw_;
};

/// Fills `cells_` with the next record; false at the end and after a quote that is never closed.
/// After another fault in a record `cells_` is empty.
bool CsvParser::scan(CsvScanner& scanner) {
  switch (scanner.next(cells_)) {
    case CsvScanner::Outcome::kRecord:
      return true;
    case CsvScanner::Outcome::kEnd:
      return false;
    case CsvScanner::Outcome::kOpenQuote:
      fault(cells_.back().line, cells_.back().character, "this quote is not closed");
      return false;
    case CsvScanner::Outcome::kTextAfterQuote:
      fault(
          cells_.back().line, cells_.back().character,
          "there is text between the closing quote of this cell and the delimiter; double a quote "
          "inside a quoted cell");
      scanner.skip_line();
      cells_.clear();
      return true;
  }
  return false;
}

/// The delimiter that finds most of the columns asked for, then the one that makes most cells.
CsvParser::Delimiter CsvParser::delimiter_of(const CsvScanner& scanner) const {
  const std::set<std::string> wanted = wanted_names(columns_, mappings_);
  int best = 0;
  Delimiter chosen;
  for (const char delimiter : {',', ';', '\t'}) {
    CsvScanner copy = scanner;
    copy.set_delimiter(delimiter);
    std::vector<CsvCell> cells;
    copy.next(cells);  // up to a fault, if there is one
    const auto found =
        static_cast<int>(std::count_if(cells.begin(), cells.end(), [&](const CsvCell& cell) {
          return wanted.count(name_of(cell)) != 0;
        }));
    const int points = 10000 * found + static_cast<int>(std::min<std::size_t>(cells.size(), 9999));
    if (points > best) {
      best = points;
      chosen = {delimiter, found};
    }
  }
  return chosen;
}

/// Some programs write the names behind a '#': the last comment above the first row, where it has as
/// many cells as that and some of the columns asked for.
bool CsvParser::take_comment_as_header() {
  CsvScanner comment(scanner_.comment());
  const Delimiter chosen = delimiter_of(comment);
  if (chosen.found == 0) return false;
  CsvScanner row = scanner_;
  row.set_delimiter(chosen.character);
  comment.set_delimiter(chosen.character);
  std::vector<CsvCell> names;
  std::vector<CsvCell> first_row;
  if (comment.next(names) != CsvScanner::Outcome::kRecord ||
      row.next(first_row) != CsvScanner::Outcome::kRecord || names.size() != first_row.size()) {
    return false;
  }
  header_cells_ = std::move(names);
  raw_.header_line = scanner_.comment_line();
  for (CsvCell& cell : header_cells_) cell.line = raw_.header_line;
  scanner_.set_delimiter(delimiter_ = chosen.character);
  return header_is_comment_ = true;
}

bool CsvParser::read_header_cells() {
  scanner_.peek_line();
  raw_.header_line = scanner_.line();
  const Delimiter chosen = delimiter_of(scanner_);
  if (chosen.found == 0 && take_comment_as_header()) return true;
  scanner_.set_delimiter(delimiter_ = chosen.character);
  const std::size_t before = faults_.size();
  if (!scan(scanner_)) {
    if (faults_.size() == before) {
      faults_.push_back({raw_.file, "the file has no header row; expected the columns' names"});
    }
    return false;
  }
  if (cells_.empty()) return false;
  header_cells_ = cells_;
  const bool numbers = std::all_of(cells_.begin(), cells_.end(), [](const CsvCell& cell) {
    return number_from_text(name_of(cell)).has_value();
  });
  if (numbers) fault(raw_.header_line, 1, "this row holds numbers; expected the columns' names");
  return !numbers;
}

/// The texts of the first row.
std::vector<std::string> CsvParser::samples() const {
  CsvScanner copy = scanner_;
  std::vector<CsvCell> cells;
  copy.next(cells);
  std::vector<std::string> texts;
  texts.reserve(cells.size());
  for (const CsvCell& cell : cells) texts.emplace_back(cell.text);
  return texts;
}

bool CsvParser::read_header() {
  if (!read_header_cells()) return false;
  for (const CsvCell& cell : header_cells_) header_.push_back(name_of(cell));
  sources_ = find_columns(header_, samples(), columns_, mappings_, raw_.file);
  for (HeaderFault& found : sources_.faults) {
    const bool placed = found.cell.has_value();
    fault(placed ? header_cells_[*found.cell].line : raw_.header_line,
          placed ? header_cells_[*found.cell].character : 1, std::move(found.message));
  }
  use_columns();
  return true;
}

void CsvParser::use_columns() {
  raw_.columns.resize(header_.size());
  std::map<std::size_t, std::size_t> place;
  for (const ColumnSource& source : sources_.found) {
    for (const std::size_t index : source.indices) {
      const auto [found, is_new] = place.emplace(index, used_.size());
      if (is_new) {
        used_.push_back({index, source.expression ? header_[index] : source.column.name, true});
      }
      if (source.time && source.time->is_date) used_[found->second].is_date = true;
      if (source.column.empty == EmptyCells::kFault) used_[found->second].may_be_empty = false;
    }
  }
}

bool CsvParser::read_row() {
  if (!scan(scanner_)) return false;
  if (cells_.empty()) return true;
  if (cells_.size() != header_.size()) {
    report_ragged();
  } else {
    read_cells();
  }
  return true;
}

void CsvParser::report_ragged() {
  const CsvCell& cell = cells_.size() > header_.size() ? cells_[header_.size()] : cells_.back();
  std::string message =
      fmt::format("this row has {} cells, the header {}", cells_.size(), header_.size());
  if (cells_.size() == 2 * header_.size()) {
    message += "; if these are decimal commas, write numbers with a point";
  }
  fault(cell.line, cell.character, std::move(message));
}

/// A fault, or a cell that may be empty, has its own mark in place of a value.
double CsvParser::value_of(const CsvCell& cell, const Used& used) {
  if (used.may_be_empty && cell.text.empty()) return kEmptyCell;
  if (used.is_date) {
    if (const auto seconds = seconds_of_date(cell.text)) return *seconds;
    fault(cell.line, cell.character,
          fmt::format("column {}: expected a date like 2026-01-31T12:34:56.789Z, as in the first "
                      "row; found \"{}\"",
                      used.name, shortened(cell.text, 40)));
    return kFaultyCell;
  }
  const auto value = number_from_text(cell.text);
  if (value) {
    if (delimiter_ != ',') note_point(cell, commas_);
    return *value;
  }
  if (delimiter_ != ',') {
    if (const auto with_comma = number_with_comma(cell, commas_)) return *with_comma;
  }
  fault(cell.line, cell.character, fmt::format("column {}: {}", used.name, value.error()));
  return kFaultyCell;
}

/// Says how the file was taken where there was something to find out; commas that cannot be are a
/// fault.
void CsvParser::note_format() {
  if (const auto wrong = fault_of(commas_)) {
    fault(commas_.comma->line, commas_.comma->character, *wrong);
  }
  if (!commas_.comma && !header_is_comment_) return;
  const std::string_view between = delimiter_ == ','   ? "commas"
                                   : delimiter_ == ';' ? "semicolons"
                                                       : "tabs";
  raw_.notes.push_back({raw_.header_line, "csv-format",
                        fmt::format("read with cells between {}{}{}", between,
                                    commas_.comma ? ", decimal commas" : "",
                                    header_is_comment_ ? ", the columns' names behind #" : "")});
}

void CsvParser::read_cells() {
  raw_.lines.push_back(cells_.front().line);
  for (const Used& used : used_) {
    const CsvCell& cell = cells_[used.index];
    raw_.columns[used.index].value.push_back(value_of(cell, used));
    raw_.columns[used.index].character.push_back(cell.character);
  }
}

/// The text without its byte order mark. Errors: it is empty or no text.
Result<std::string_view> text_of(std::string_view bytes, const std::string& file) {
  if (bytes.empty()) {
    return input_error(file, "the file is empty; expected a header row and rows");
  }
  if (bytes.find('\0') != std::string_view::npos) {
    return input_error(file, "this is not UTF-8 text (UTF-16?); save it as UTF-8");
  }
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  return bytes;
}

}  // namespace

Result<CsvTable> read_csv_text(std::string_view bytes, const std::string& file,
                               std::span<const CsvColumn> columns,
                               std::span<const ColumnMapping> mappings) {
  AWMR_ASSIGN_OR_RETURN(const std::string_view text, text_of(bytes, file));
  return CsvParser(file, text, columns, mappings).parse();
}

Result<CsvHead> csv_head(std::string_view bytes, const std::string& file,
                         std::span<const CsvColumn> columns,
                         std::span<const ColumnMapping> mappings, std::size_t most_rows) {
  AWMR_ASSIGN_OR_RETURN(const std::string_view text, text_of(bytes, file));
  return CsvParser(file, text, columns, mappings).head(most_rows);
}

Result<CsvTable> read_csv(const std::filesystem::path& path, std::span<const CsvColumn> columns,
                          std::span<const ColumnMapping> mappings) {
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
  return read_csv_text(bytes, path.string(), columns, mappings);
}

}  // namespace awmr
