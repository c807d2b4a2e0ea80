#include "awmr/core/csv/csv_scanner.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::array<double, 20> kPowersOfTen{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                              1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                              1e14, 1e15, 1e16, 1e17, 1e18, 1e19};

/// Parses a number such as `-12.5` at the beginning of `text` and returns its length. Computes the
/// value as an integer divided by a power of ten, here 125/10, which is several times faster than
/// std::from_chars. The value is correctly rounded if both numbers are exact as double; otherwise
/// `value` remains empty. [Clinger, How to Read Floating Point Numbers Accurately, 1990]
std::size_t parse_plain_number(std::string_view text, std::optional<double>& value) {
  constexpr std::uint64_t kMaxExact = std::uint64_t{1} << 53U;
  const std::size_t first = text.starts_with('-') ? 1 : 0;
  std::size_t end = first;
  std::size_t point = std::string_view::npos;
  std::uint64_t number = 0;
  for (; end < text.size(); ++end) {
    const auto digit = static_cast<unsigned char>(text[end] - '0');
    if (digit <= 9) {
      number = 10 * number + digit;
    } else if (text[end] == '.' && point == std::string_view::npos) {
      point = end;
    } else {
      break;
    }
  }
  const bool has_point = point != std::string_view::npos;
  const std::size_t digits = end - first - (has_point ? 1 : 0);
  if (digits == 0 || digits >= kPowersOfTen.size() || number > kMaxExact) return end;
  const double size = static_cast<double>(static_cast<std::int64_t>(number)) /
                      kPowersOfTen[has_point ? end - point - 1 : 0];
  value = first == 1 ? -size : size;
  return end;
}

}  // namespace

/// Skips one byte, which is not a line end.
inline void CsvScanner::step() {
  character_ += continues_character(rest_.front()) ? 0 : 1;
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
  CsvCell& cell = cells.emplace_back();
  cell.line = line_;
  const std::size_t number_length = parse_plain_number(rest_, cell.number);
  std::size_t length = number_length;
  int characters = static_cast<int>(number_length);
  for (; length < rest_.size(); ++length) {
    const char c = rest_[length];
    if (c == delimiter_ || c == '\n' || c == '\r') break;
    characters += continues_character(c) ? 0 : 1;
  }
  if (length > number_length) cell.number.reset();
  cell.text = trimmed(rest_.substr(0, length));
  cell.character = cell.text.empty() ? start : character_;
  rest_.remove_prefix(length);
  character_ += characters;
  return Outcome::kRecord;
}

CsvScanner::Outcome CsvScanner::quoted_cell(std::vector<CsvCell>& cells) {
  cells.push_back({{}, line_, character_, true, {}});
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
