/// Splits the bytes of a CSV file into records of cells.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace awmr {

/// One cell: its text without quotes and outer spaces, and its position, from 1.
struct CsvCell {
  std::string_view text;
  int line = 1;
  int character = 1;
  bool is_quoted = false;
  std::optional<double> number = {};  ///< of most numbers; number_from_text() parses the others
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
  /// Cells of the next record, up to the first fault, for another delimiter; reads nothing.
  std::vector<CsvCell> peek_cells(char delimiter) const;

  /// Skips the rest of the line after a fault.
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
