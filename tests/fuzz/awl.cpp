/// An on-board log is read with finite, ordered rows, or refused. The counts of lost and damaged
/// data add up. Memory is bounded.
#include "awmr/trials/awl.h"

#include <cmath>

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using awmr::fuzz::require;
  const auto log = awmr::read_awl(awmr::fuzz::text_of(data, size), "a.awl");
  if (!log) {
    require(!log.error().faults.empty(), "an error names a fault");
    require(to_text(log.error()).size() < 100'000, "an error can be read");
    return 0;
  }
  require(log->header.size() == log->columns.size(), "a column has a name");
  require(log->rows() * 9 <= size, "a row has its bytes");
  require(log->damaged_bytes <= size, "no more is damaged than there is");
  const auto& runs = log->columns.back();
  for (const auto& column : log->columns) {
    require(column.size() == log->rows(), "a column has a value by row");
    for (const double value : column) require(std::isfinite(value), "a value is finite");
  }
  for (std::size_t row = 1; row < log->rows(); ++row) {
    require(runs[row] >= runs[row - 1], "runs are in order");
    require(runs[row] > runs[row - 1] || log->columns[0][row] > log->columns[0][row - 1],
            "time rises within a run");
  }
  return 0;
}
