/// Fuzz target: reads the bytes as a SysId record. The reader returns a value for every cell, or an
/// error.
#include "awmr/trials/formats/log_formats.h"

#include <cmath>

#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = awmr::fuzz::text_of(data, size);
  const auto log = awmr::read_sysid(text, "a.json");
  if (!log) {
    require(!log.error().faults.empty(), "an error has at least one fault");
    return 0;
  }
  require(log->header.size() == log->columns.size() && log->rows() > 0, "a log has rows");
  for (const auto& column : log->columns) {
    require(column.size() == log->rows(), "a column has one value per row");
  }
  for (std::size_t i = 1; i < log->rows(); ++i) {
    const bool is_same_run = log->columns[0][i] == log->columns[0][i - 1];
    require(!is_same_run || log->columns[1][i] > log->columns[1][i - 1] - 1e-9,
            "time increases from row to row");
  }
  return 0;
}
