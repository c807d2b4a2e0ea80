#include "awmr/core/csv_scanner.h"

#include <algorithm>
#include <array>

#include "awmr/core/csv_cell.h"

namespace awmr {
namespace {

/// Number of UTF-8 characters: bytes other than continuations 10xxxxxx.
int characters(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

/// Characters ignored around a cell: not the tab if it is the delimiter.
const char* blanks(char delimiter) { return delimiter == '\t' ? " " : " \t"; }

}  // namespace

std::string_view CsvScanner::peek_line() {
  while (!rest_.empty()) {
    const std::string_view text = rest_.substr(0, rest_.find_first_of("\r\n"));
    const std::size_t first = text.find_first_not_of(blanks(delimiter_));
    if (first != std::string_view::npos && text[first] != '#') return text;
    if (first != std::string_view::npos) {
      comment_ = text.substr(std::min(text.find_first_not_of('#', first), text.size()));
      comment_line_ = line_;
    }
    rest_.remove_prefix(text.size());
    end_line();
  }
  return {};
}

CsvScanner::Outcome CsvScanner::next(std::vector<CsvCell>& cells) {
  cells.clear();
  if (peek_line().empty()) return Outcome::kEnd;
  character_ = 1;
  while (true) {
    const Outcome outcome = cell(cells);
    if (outcome != Outcome::kRecord) return outcome;
    if (rest_.empty() || rest_[0] != delimiter_) break;
    advance(1);
  }
  end_line();
  return Outcome::kRecord;
}

void CsvScanner::skip_line() {
  rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size()));
  end_line();
}

void CsvScanner::advance(std::size_t bytes) {
  character_ += characters(rest_.substr(0, bytes));
  rest_.remove_prefix(bytes);
}

void CsvScanner::skip_spaces() {
  advance(std::min(rest_.find_first_not_of(blanks(delimiter_)), rest_.size()));
}

/// Consumes LF, CRLF or CR.
void CsvScanner::end_line() {
  if (rest_.empty()) return;
  rest_.remove_prefix(rest_.substr(0, 2) == "\r\n" ? 2 : 1);
  ++line_;
}

CsvScanner::Outcome CsvScanner::cell(std::vector<CsvCell>& cells) {
  const int start = character_;
  skip_spaces();
  if (!rest_.empty() && rest_[0] == '"') return quoted_cell(cells);
  const std::array<char, 3> ends{delimiter_, '\r', '\n'};
  const std::size_t length =
      std::min(rest_.find_first_of(std::string_view(ends.data(), ends.size())), rest_.size());
  const std::string_view text = trimmed(rest_.substr(0, length));
  cells.push_back({text, line_, text.empty() ? start : character_, false});
  advance(length);
  return Outcome::kRecord;
}

CsvScanner::Outcome CsvScanner::quoted_cell(std::vector<CsvCell>& cells) {
  cells.push_back({{}, line_, character_, true});
  advance(1);
  std::size_t end = rest_.find('"');
  while (end != std::string_view::npos && rest_.substr(end, 2) == "\"\"") {
    end = rest_.find('"', end + 2);
  }
  has_open_quote_ = end == std::string_view::npos;
  if (has_open_quote_) return Outcome::kOpenQuote;
  const std::string_view text = rest_.substr(0, end);
  cells.back().text = trimmed(text);
  advance(end + 1);
  if (const std::size_t last = text.rfind('\n'); last != std::string_view::npos) {
    line_ += static_cast<int>(std::count(text.begin(), text.end(), '\n'));
    character_ = characters(text.substr(last + 1)) + 2;
  }
  skip_spaces();
  const bool ended =
      rest_.empty() || rest_[0] == delimiter_ || rest_[0] == '\r' || rest_[0] == '\n';
  return ended ? Outcome::kRecord : Outcome::kTextAfterQuote;
}

}  // namespace awmr
