/// The log of the emitted firmware (`.awl`): control/log_row.h says what is in a file, its header
/// says what is in a row.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

/// What a file holds, and what of it is lost.
struct AwlLog {
  std::vector<std::string> header = {};           ///< `t_s` first, `run` last
  std::vector<std::vector<double>> columns = {};  ///< of each name, by row; all finite
  std::string parameters_sha256 = {};  ///< of the firmware's model and gains, as in awmr_params.h
  std::size_t runs = 0;                ///< 1, and one more wherever the chip began anew
  std::size_t lost = 0;                ///< rows that the chip numbered and that are not in the file
  std::size_t damaged_bytes = 0;       ///< that belong to no whole header and no whole row
  std::vector<Finding> findings = {};

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// A header begins within the first kilobytes.
bool is_awl(std::string_view bytes);

/// All whole rows of a file, its rows told by their check sums wherever they begin. Told as findings:
/// rows whose number is missing (`rows-lost`), bytes that are no row (`log-damaged`), a file that
/// ends inside a row (`log-truncated`), rows set aside because what they say was measured was not
/// (`rows-not-measured`) or because their run is too short to be a log (`short-run`), each with its
/// places, and a chip that was reset without being switched off (`chip-reset`).
/// Errors (input): no header that is whole, one of another version, or one that does not describe
/// its rows; two headers that describe them differently; (refused) no row that is whole.
Result<AwlLog> read_awl(std::string_view bytes, const std::string& file);

/// As read_awl() of a file's bytes, whose hash is noted. Errors: as read_input().
Result<AwlLog> read_awl_file(const std::filesystem::path& path);

/// The contract's log: header and rows, every number in the shortest form that reads back the same.
std::string log_csv(const AwlLog& log);

}  // namespace awmr
