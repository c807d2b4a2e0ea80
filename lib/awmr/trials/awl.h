/// Log of the emitted firmware (`.awl`). control/log_row.h defines the file, and the file's header
/// defines its rows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

/// Content of a file, with counts of the lost data.
struct AwlLog {
  std::vector<std::string> header = {};           ///< `t_s` first, `run` last
  std::vector<std::vector<double>> columns = {};  ///< by name, then by row; all finite
  std::string parameters_sha256 = {};  ///< of the firmware's model and gains, as in awmr_params.h
  std::size_t runs = 0;                ///< 1, plus one for each restart of the chip
  std::size_t lost = 0;                ///< rows numbered by the chip but missing from the file
  std::size_t damaged_bytes = 0;       ///< bytes outside complete headers and rows
  std::vector<Finding> findings = {};

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// True if a header begins within the first kilobytes.
bool is_awl(std::string_view bytes);

/// Reads all complete rows of a file; a checksum identifies a row wherever it begins. Findings,
/// each with its places:
///   `rows-lost`          missing row numbers
///   `log-damaged`        bytes that are not a row
///   `log-truncated`      the file ends inside a row
///   `rows-not-measured`  rows set aside because their motion is not a current measurement
///   `short-run`          rows set aside because their run is too short to be a log
///   `chip-reset`         the chip was reset without being switched off
/// Errors: (input) no complete header, a header of another version or one that does not describe
/// its rows, two headers that differ; (refused) no complete row.
Result<AwlLog> read_awl(std::string_view bytes, const std::string& file);

/// Like read_awl() for a file, whose hash is recorded. Errors: as read_input().
Result<AwlLog> read_awl_file(const std::filesystem::path& path);

/// The log as CSV: header and rows, every number in the shortest form that reads back the same.
std::string log_csv(const AwlLog& log);

}  // namespace awmr
