#include "awmr/core/csv_scanner.h"

#include <cstddef>

#include "awmr/core/csv_cell.h"

namespace awmr {
namespace {

/// UTF-8: continuation bytes are 10xxxxxx.
bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

}  // namespace

/// Skips a byte within a line.
inline void CsvScanner::step() {
  character_ += begins_character(rest_.front()) ? 1 : 0;
  rest_.remove_prefix(1);
}

void CsvScanner::skip_spaces() {
  while (is_at_blank()) step();
}

/// Consumes LF, CRLF or CR.
void CsvScanner::end_line() {
  if (rest_.empty()) return;
  rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : 1);
  ++line_;
}

void CsvScanner::skip_line() {
  while (!is_at_end_of_line()) rest_.remove_prefix(1);
  end_line();
}

/// Skips comments and blank lines; false at the end of the text.
bool CsvScanner::find_record() {
  while (!rest_.empty()) {
    const std::string_view line = rest_;
    skip_spaces();
    if (!is_at_end_of_line() && !is_at('#')) {
      rest_ = line;
      return true;
    }
    if (!is_at_end_of_line()) {
      comment_line_ = line_;
      while (is_at('#')) rest_.remove_prefix(1);
      comment_ = rest_.substr(0, rest_.find_first_of("\r\n"));
    }
    skip_line();
  }
  return false;
}

std::string_view CsvScanner::peek_line() {
  if (!find_record()) return {};
  return rest_.substr(0, rest_.find_first_of("\r\n"));
}

CsvScanner::Outcome CsvScanner::next(std::vector<CsvCell>& cells) {
  cells.clear();
  if (!find_record()) return Outcome::kEnd;
  character_ = 1;
  while (true) {
    const Outcome outcome = cell(cells);
    if (outcome != Outcome::kRecord) return outcome;
    if (is_at_end_of_line()) break;
    step();  // the delimiter
  }
  end_line();
  return Outcome::kRecord;
}

std::vector<CsvCell> CsvScanner::peek_cells(char delimiter) const {
  CsvScanner copy = *this;
  copy.set_delimiter(delimiter);
  std::vector<CsvCell> cells;
  copy.next(cells);
  return cells;
}

CsvScanner::Outcome CsvScanner::cell(std::vector<CsvCell>& cells) {
  const int start = character_;
  skip_spaces();
  if (is_at('"')) return quoted_cell(cells);
  const char delimiter = delimiter_;
  std::size_t length = 0;
  int characters = 0;
  for (const char c : rest_) {
    if (c == delimiter || c == '\n' || c == '\r') break;
    ++length;
    characters += begins_character(c) ? 1 : 0;
  }
  const std::string_view text = trimmed(rest_.substr(0, length));
  cells.push_back({text, line_, text.empty() ? start : character_, false});
  rest_.remove_prefix(length);
  character_ += characters;
  return Outcome::kRecord;
}

CsvScanner::Outcome CsvScanner::quoted_cell(std::vector<CsvCell>& cells) {
  cells.push_back({{}, line_, character_, true});
  step();
  const std::string_view begin = rest_;
  for (; !rest_.empty(); step()) {
    if (rest_.starts_with("\"\"")) {
      step();
    } else if (is_at('"')) {
      break;
    } else if (is_at('\n')) {
      ++line_;
      character_ = 0;
    }
  }
  if (rest_.empty()) return Outcome::kOpenQuote;
  cells.back().text = trimmed(begin.substr(0, begin.size() - rest_.size()));
  step();
  skip_spaces();
  const bool has_ended = is_at_end_of_line() || is_at(delimiter_);
  return has_ended ? Outcome::kRecord : Outcome::kTextAfterQuote;
}

}  // namespace awmr
