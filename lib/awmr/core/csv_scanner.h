/// Splits the bytes of a CSV file into records of cells.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace awmr {

/// One cell: its text without quotes and outer spaces, and its position, from 1.
struct CsvCell {
  std::string_view text;
  int line = 1;
  int character = 1;
  bool is_quoted = false;
};

class CsvScanner {
 public:
  enum class Outcome { kRecord, kEnd, kOpenQuote, kTextAfterQuote };

  /// `bytes` without a byte order mark.
  explicit CsvScanner(std::string_view bytes) : rest_(bytes) {}
  void set_delimiter(char delimiter) { delimiter_ = delimiter; }

  /// Skips comments and blank lines. Returns the next line, whose number is line().
  std::string_view peek_line();
  int line() const { return line_; }
  /// The last comment that was skipped, without its '#', and its line; line 0: there was none.
  std::string_view comment() const { return comment_; }
  int comment_line() const { return comment_line_; }

  /// Reads the next record. On a fault, the last cell is the faulty one.
  Outcome next(std::vector<CsvCell>& cells);

  /// Skips the rest of the line after a fault.
  void skip_line();

  /// Bytes not scanned yet.
  std::size_t left() const { return rest_.size(); }
  /// All bytes were read: if the text was cut off, the last record can be incomplete.
  bool ran_out() const { return has_open_quote_ || rest_.empty(); }

 private:
  void advance(std::size_t bytes);
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
  bool has_open_quote_ = false;
};

}  // namespace awmr
