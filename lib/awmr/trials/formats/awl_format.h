/// Parses the header of an `.awl` file, which defines the columns of its rows. Finds rows, damaged
/// bytes and missing rows. Private to trials/.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"

namespace awmr::awl {

enum class Kind { kFloat, kUnsigned, kByte };

struct Column {
  std::string name;
  Kind kind = Kind::kFloat;
  double scale = 1.0;      ///< physical value of the column = stored number times this
  std::size_t offset = 0;  ///< byte offset in the row

  bool operator==(const Column&) const = default;
};

/// Layout of the rows of a file.
struct Layout {
  std::string parameters_sha256;  ///< SHA-256 of the model and gains in the firmware
  std::size_t row_bytes = 0;
  std::vector<Column> columns;  ///< columns in the order of the row; the first is t_s

  bool operator==(const Layout&) const = default;
};

/// Returns the scaled value of a column. Precondition: `row` has Layout::row_bytes bytes.
double value_in(std::string_view row, const Column& column);

/// Returns the stored byte of the one-byte column `name`, without applying the scale. Used for
/// columns of bits, such as `fault`. 0 if the layout has no such column.
unsigned bits_in(std::string_view row, const Layout& layout, std::string_view name);

struct Place {
  std::size_t offset = 0;  ///< bytes from the beginning of the file
  std::size_t run = 1;     ///< number of the run, from 1; each start of the chip begins a run
};

/// Bytes [begin, end) that are neither header nor row.
struct Damage {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Gap in the numbers that the chip gives its rows: rows that are missing from the file.
struct Lost {
  std::size_t count = 0;  ///< number of missing rows
  double before_s = 0.0;  ///< t_s of the row after the gap
  /// True: the file is damaged at the gap. False: the chip did not write the rows, because it had
  /// no room to buffer them.
  bool is_damaged = false;
};

struct Scan {
  Layout layout = {};  ///< layout of the rows; row_bytes is 0 if no complete header was found
  std::vector<Place> rows = {};
  std::vector<Damage> damaged = {};
  std::vector<Lost> lost = {};
  std::size_t truncated = 0;  ///< length of an incomplete row at the end, bytes
};

/// Finds all rows by their checksums. Errors (input): those of read_awl() in awl.h.
Result<Scan> scan_of(std::string_view bytes, const std::string& file);

/// t_s of the row at this offset.
double time_of(std::string_view bytes, std::size_t offset, const Layout& layout);

}  // namespace awmr::awl
