/// Finds rows, damaged bytes and missing rows of an `.awl` file. Private to this folder.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "awl_header.h"
#include "awmr/core/result.h"

namespace awmr::awl {

/// Position of a complete row.
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
  /// True: the file is damaged at the gap. False: the chip did not write the rows.
  bool is_damaged = false;
};

struct Scan {
  Layout layout = {};  ///< layout of the rows; row_bytes is 0 if no complete header was found
  std::vector<Place> rows = {};
  std::vector<Damage> damaged = {};
  std::vector<Lost> lost = {};
  std::size_t truncated = 0;  ///< length of an incomplete row at the end, bytes
};

/// True if the bytes are probably an `.awl` file: the first bytes of a header occur within the
/// first 8 KiB.
bool begins_log(std::string_view bytes);

/// Finds all rows by their checksums. Errors (input): no complete header; a header that layout_of()
/// refuses; two headers that differ; more than 1000 damaged headers.
Result<Scan> scan_of(std::string_view bytes, const std::string& file);

/// t_s of the row at this offset.
double time_of(std::string_view bytes, std::size_t offset, const Layout& layout);

}  // namespace awmr::awl
