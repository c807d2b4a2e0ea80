/// Which bytes of an `.awl` file are rows, which are nothing, and which rows are missing. Private to
/// this folder.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "awl_header.h"
#include "awmr/core/result.h"

namespace awmr::awl {

/// A row that is whole.
struct Place {
  std::size_t offset = 0;
  std::size_t run = 1;
};

/// Bytes that are neither header nor row.
struct Damage {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Rows with numbers that are not in the file.
struct Lost {
  std::size_t count = 0;
  double before_s = 0.0;    ///< time of the next row
  bool is_damaged = false;  ///< bytes between the rows were, else the chip did not write them
};

struct Scan {
  Layout layout = {};  ///< of the rows; row_bytes 0: there is no whole header
  std::vector<Place> rows = {};
  std::vector<Damage> damaged = {};
  std::vector<Lost> lost = {};
  std::size_t truncated = 0;  ///< bytes at the end that begin a row
};

/// A header seems to begin within the first kilobytes.
bool begins_log(std::string_view bytes);

/// Finds rows by their check sums, wherever they begin. Errors (input): no whole header; as
/// layout_of(); headers that differ; damaged headers without end.
Result<Scan> scan_of(std::string_view bytes, const std::string& file);

/// t_s of the row at this place.
double time_of(std::string_view bytes, std::size_t offset, const Layout& layout);

}  // namespace awmr::awl
