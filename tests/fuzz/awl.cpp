/// Fuzz target: reads the bytes as an on-board log (AWL). The reader returns finite, ordered rows
/// and consistent counts of lost and damaged data, or an error. Memory is bounded.
#include "awmr/trials/awl.h"

#include <cmath>

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using awmr::fuzz::require;
  const auto log = awmr::read_awl(awmr::fuzz::text_of(data, size), "a.awl");
  if (!log) {
    require(!log.error().faults.empty(), "an error has at least one fault");
    require(to_text(log.error()).size() < 100'000, "the error text is short");
    return 0;
  }
  require(log->header.size() == log->columns.size(), "a column has a name");
  require(log->rows() * 9 <= size, "the rows need no more bytes than the log has");
  require(log->damaged_bytes <= size, "at most all bytes are damaged");
  const auto& runs = log->columns.back();
  for (const auto& column : log->columns) {
    require(column.size() == log->rows(), "a column has one value per row");
    for (const double value : column) require(std::isfinite(value), "a value is finite");
  }
  for (std::size_t row = 1; row < log->rows(); ++row) {
    require(runs[row] >= runs[row - 1], "run numbers do not decrease");
    require(runs[row] > runs[row - 1] || log->columns[0][row] > log->columns[0][row - 1],
            "time increases within a run");
  }
  return 0;
}
