/// Collects the text of a driving log from a stream of bytes, such as a serial port (`awmr live`).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/model/record.h"

namespace awmr {

/// Maximum line length in bytes; a longer line counts as damaged.
inline constexpr std::size_t kMaxRecordedLine = std::size_t{1} << 16U;
/// Maximum size of a recording in bytes: about two million rows.
inline constexpr std::size_t kMaxRecording = std::size_t{1} << 28U;

/// The recorded text of one stream. Lines that are not rows of data are "set aside". They are
/// damaged (a serial port loses bytes) or other text (a board prints messages, and its header again
/// after a restart). Such a line stays at its place as a comment of at most 200 bytes, so that line
/// numbers match the stream.
///
/// The header is the first line that names a column of a log. It may be a comment (`#`). Lines
/// above an uncommented header are set aside. Below the header, these lines are set aside:
///   - lines with more or fewer cells than the header, and repetitions of the header;
///   - lines with a cell that has digits but is not a number, if the first row has a number in this
///     column;
///   - lines with control characters, lines that are too long, and a last line without line end.
/// A number that lost a digit cannot be detected.
class Recording {
 public:
  /// `mappings`: column mappings with which the log will be read. A line that contains the names of
  /// their source columns is recognised as the header, as is a line with awmr's column names.
  /// `most_bytes`: maximum size of the text.
  explicit Recording(std::vector<ColumnMapping> mappings = {},
                     std::size_t most_bytes = kMaxRecording);

  /// Adds the next piece of the stream. Drops lines beyond `most_bytes`; full() is then true.
  void add(std::string_view bytes);
  /// Ends the stream. A last line without line end is set aside, because the stream may have ended
  /// inside a number.
  void finish();

  /// The complete lines so far.
  const std::string& text() const { return text_; }
  /// Number of rows of data. Lines set aside, comments and empty lines are not counted.
  std::size_t rows() const { return rows_; }
  bool has_header() const { return !header_.names.empty(); }
  std::size_t set_aside() const { return set_aside_; }
  bool full() const { return full_; }
  /// Returns the finding `lines-set-aside` with its place in `file`; empty if no line was set
  /// aside.
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
  std::string line_ = {};  ///< last line, which is still incomplete
  bool line_too_long_ = false;
  /// True: the last byte was a carriage return; a line feed after it ends the same line.
  bool after_return_ = false;
  bool full_ = false;
  CsvHead header_ = {};
  /// Column names in the last comment; it becomes the header if rows with as many cells follow.
  CsvHead commented_ = {};
  std::vector<bool> is_number_ = {};  ///< for each column: true if the first row has a number in it
  int lines_ = 0;                     ///< number of lines in text_
  std::size_t rows_ = 0;
  std::size_t set_aside_ = 0;
  int first_aside_ = 0;  ///< line number of the first line set aside
  std::string first_why_ = {};
};

}  // namespace awmr
