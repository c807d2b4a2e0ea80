/// A SysId record is read with a value in every cell, or refused.
#include "awmr/trials/sysid.h"

#include <cmath>

#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = awmr::fuzz::text_of(data, size);
  const auto log = awmr::read_sysid(text, "a.json");
  if (!log) {
    require(!log.error().faults.empty(), "a refusal has a reason");
    return 0;
  }
  require(log->header.size() == log->columns.size() && log->rows() > 0, "a log has rows");
  for (const auto& column : log->columns) {
    require(column.size() == log->rows(), "every row has every value");
  }
  for (std::size_t i = 1; i < log->rows(); ++i) {
    const bool is_same_run = log->columns[0][i] == log->columns[0][i - 1];
    require(!is_same_run || log->columns[1][i] > log->columns[1][i - 1] - 1e-9, "time rises");
  }
  return 0;
}
