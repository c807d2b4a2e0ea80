/// Collects a driving log from a stream: bytes in pieces of any size -> the text of a log in whole
/// lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/model/record.h"

namespace awmr {

/// Maximum line length in bytes; a longer line is damaged.
inline constexpr std::size_t kMaxRecordedLine = std::size_t{1} << 16U;
/// Maximum recording size in bytes: some two million rows.
inline constexpr std::size_t kMaxRecording = std::size_t{1} << 28U;

/// A serial line loses bytes. A board prints text before its header and repeats the header after a
/// restart. Such a line stays in the text at its place, as a comment: nothing is lost, line numbers
/// match the stream, and the rest is an ordinary log.
///
/// Once the header is known (the first line that names a column of a log), these are set aside:
///   lines with more or fewer cells than the header, or a repeated header
///   lines with a cell that has digits but is not a number, where the first row had a number
///   lines with control characters, too long, or without an end
/// A number that lost a digit cannot be detected.
class Recording {
 public:
  struct Header {
    std::vector<std::string> names = {};
    char delimiter = ',';
  };

  /// `mappings`: those with which the log will be read, so that a header with other names is
  /// recognised. `most_bytes`: limit of the text.
  explicit Recording(std::vector<ColumnMapping> mappings = {},
                     std::size_t most_bytes = kMaxRecording);

  /// Adds the next piece of the stream. Data beyond the limit are dropped; see full().
  void add(std::string_view bytes);
  /// Ends the stream. A last line without an end may be cut inside a number and is set aside.
  void finish();

  /// The complete lines.
  const std::string& text() const { return text_; }
  /// Lines after the header, without those set aside, comments and empty lines.
  std::size_t rows() const { return rows_; }
  bool has_header() const { return !header_.names.empty(); }
  std::size_t set_aside() const { return set_aside_; }
  bool full() const { return full_; }
  /// Reports the lines set aside, with reasons, for `file`: `lines-set-aside`, or nothing.
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
  std::string line_ = {};  ///< incomplete last line
  bool line_too_long_ = false;
  bool after_return_ = false;  ///< the last byte was a carriage return, which ended its line
  bool full_ = false;
  Header header_ = {};
  Header commented_ = {};             ///< last header candidate after a '#', above the first row
  std::vector<bool> is_number_ = {};  ///< by column, in the first row
  int lines_ = 0;                     ///< lines in text_
  std::size_t rows_ = 0;
  std::size_t set_aside_ = 0;
  int first_aside_ = 0;  ///< line number of the first line set aside
  std::string first_why_ = {};
};

}  // namespace awmr
