/// Reads the log that the emitted firmware writes on its board (`.awl`). trials/awl_row.h defines
/// the file format. The header of each file defines the columns of its rows.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

/// Rows of an `.awl` file, and how many rows and bytes were lost.
struct AwlLog {
  std::vector<std::string> header = {};  ///< column names: `t_s` first, `run` last
  /// One vector per column, with one finite value per row.
  std::vector<std::vector<double>> columns = {};
  std::string parameters_sha256 = {};  ///< hash of the model and gains, as in awmr_params.h
  /// Number of runs. Each start of the chip begins a run. Runs of fewer than ten usable rows are
  /// not counted.
  std::size_t runs = 0;
  std::size_t lost = 0;  ///< rows numbered by the chip but missing from the file
  /// Number of bytes that belong neither to a header nor to a row. The bytes of an incomplete last
  /// row are not counted.
  std::size_t damaged_bytes = 0;
  std::vector<Finding> findings = {};

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// True if the bytes are probably an `.awl` file: the first bytes of a header occur within the
/// first 8 KiB.
bool is_awl(std::string_view bytes);

/// Reads all complete rows of a file. Each row has its own checksum, so the function finds rows
/// after damaged bytes, too. Adds the findings of FORMATS.md, each with the places in the file.
/// Errors (input): no complete header; a header that layout_of() refuses (awl_format.cpp); two
/// headers that differ; more than 1000 damaged headers. Errors (refused): no usable row.
Result<AwlLog> read_awl(std::string_view bytes, const std::string& file);

/// Returns the log as CSV text. Numbers are written in the shortest form that reads back exactly.
std::string log_csv(const AwlLog& log);

}  // namespace awmr
