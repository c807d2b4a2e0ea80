/// Splits the bytes of a CSV file into records (rows) of cells.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace awmr {

struct CsvCell {
  std::string_view text;  ///< without quotes and outer spaces
  int line = 1;
  int character = 1;  ///< position of the cell in its line, in characters from 1
  bool is_quoted = false;
  /// The value, if the text is a plain number such as -12.5. number_from_text() parses texts in any
  /// other form.
  std::optional<double> number = {};
};

/// Reads one record (row) after the other.
class CsvScanner {
 public:
  /// kEnd: no further record. Faults: kOpenQuote, a quoted cell is not closed; kTextAfterQuote,
  /// text between the closing quote of a cell and the delimiter.
  enum class Outcome { kRecord, kEnd, kOpenQuote, kTextAfterQuote };

  /// Starts at the first byte of `bytes`, which must not have a byte order mark.
  explicit CsvScanner(std::string_view bytes) : rest_(bytes) {}
  void set_delimiter(char delimiter) { delimiter_ = delimiter; }

  /// Skips comments and blank lines. Returns the next line without consuming it; line() is its
  /// number.
  std::string_view peek_line();
  int line() const { return line_; }
  /// The last comment that was skipped, without its '#'.
  std::string_view comment() const { return comment_; }
  /// Line of the comment that comment() returns; 0: no comment was skipped.
  int comment_line() const { return comment_line_; }

  /// Reads the next record. On a fault (kOpenQuote, kTextAfterQuote), the last cell is the faulty
  /// one.
  Outcome next(std::vector<CsvCell>& cells);
  /// Cells of the next record, split by another delimiter, up to the first fault. next() still
  /// reads this record.
  std::vector<CsvCell> peek_cells(char delimiter) const;

  /// Skips the rest of the current line, for example after a fault.
  void skip_line();

 private:
  bool is_at(char c) const { return !rest_.empty() && rest_.front() == c; }
  bool is_at_end_of_line() const { return rest_.empty() || is_at('\n') || is_at('\r'); }
  bool is_at_blank() const { return is_at(' ') || (is_at('\t') && delimiter_ != '\t'); }
  bool find_record();
  void step();
  void skip_spaces();
  void end_line();
  Outcome cell(std::vector<CsvCell>& cells);
  Outcome quoted_cell(std::vector<CsvCell>& cells);

  std::string_view rest_;
  std::string_view comment_ = {};
  int comment_line_ = 0;
  char delimiter_ = ',';
  int line_ = 1;
  int character_ = 1;
};

}  // namespace awmr
