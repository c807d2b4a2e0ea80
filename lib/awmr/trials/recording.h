/// A driving log while it comes in: bytes in pieces of any size -> the text of a log in whole lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/model/record.h"

namespace awmr {

/// The longest line that is taken, in bytes; a longer one is damaged.
inline constexpr std::size_t kMaxRecordedLine = std::size_t{1} << 16U;
/// The most that is recorded, in bytes: some two million rows.
inline constexpr std::size_t kMaxRecording = std::size_t{1} << 28U;

/// A serial line loses bytes, a board prints words before its header and the header again when it
/// restarts. Such a line stays in the text, at its place, as a comment: nothing is lost, the numbers
/// of the lines are the stream's own, and what remains is an ordinary log.
///
/// Set aside are, once the header is known (the first line that names a column of a log):
///   lines with more or fewer cells than it, or as a second header
///   lines with a cell that has digits but is no number, where the first row had a number
///   lines with control characters, too long, or without an end
/// A number that lost a digit cannot be told from a right one.
class Recording {
 public:
  struct Header {
    std::vector<std::string> names = {};
    char delimiter = ',';
  };

  /// `mappings`: those that the log will be read with, so that a header in other words is known.
  /// `most_bytes`: of text.
  explicit Recording(std::vector<ColumnMapping> mappings = {},
                     std::size_t most_bytes = kMaxRecording);

  /// The next piece of the stream. Beyond the bound it is dropped; see full().
  void add(std::string_view bytes);
  /// The stream is over. A line without an end may have been cut in a number: it is set aside.
  void finish();

  /// Whole lines.
  const std::string& text() const { return text_; }
  /// Lines behind the header that were not set aside, comments and empty ones left out.
  std::size_t rows() const { return rows_; }
  bool has_header() const { return !header_.names.empty(); }
  std::size_t set_aside() const { return set_aside_; }
  bool full() const { return full_; }
  /// What was set aside and why, of `file`: `lines-set-aside`, or nothing.
  std::vector<Finding> findings(const std::string& file) const;

 private:
  void end_line();
  void take(const std::string& line);
  bool find_header(const std::string& line);
  void put_before_aside();
  std::string damage_of(const std::string& line);
  void put(std::string_view line);
  void put_aside(std::string_view line, std::string why);

  std::vector<ColumnMapping> mappings_;
  std::size_t most_bytes_;
  std::string text_ = {};
  std::string line_ = {};  ///< so far
  bool line_too_long_ = false;
  bool after_return_ = false;  ///< the last byte was a carriage return, which ended its line
  bool full_ = false;
  Header header_ = {};
  Header commented_ = {};             ///< the last one behind a '#', above the first row
  std::vector<bool> is_number_ = {};  ///< by column, in the first row
  int lines_ = 0;                     ///< in text_
  std::size_t rows_ = 0;
  std::size_t set_aside_ = 0;
  int first_aside_ = 0;  ///< line of the first one set aside
  std::string first_why_ = {};
};

}  // namespace awmr
