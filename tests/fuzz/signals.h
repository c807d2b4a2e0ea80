/// Checks of the signals that a reader of external logs returns.
#pragma once

#include <cmath>

#include "awmr/trials/formats/signals.h"
#include "fuzz/target.h"

namespace awmr::fuzz {

/// Aborts unless every column of the signals has one value per message and there are no more values
/// than bytes in the log. Then converts the signals to a table, which may refuse them.
inline void check(Result<Signals> signals, std::size_t bytes) {
  if (!signals) {
    require(!signals.error().faults.empty(), "an error has at least one fault");
    require(to_text(signals.error()).size() < 100'000, "the error text is short");
    return;
  }
  std::size_t values = 0;
  for (const Topic& topic : signals->topics) {
    require(topic.columns.size() == topic.values.size(), "there are values for each column");
    for (std::size_t c = 0; c < topic.columns.size(); ++c) {
      require(topic.columns[c] < signals->header.size(), "a column has a name");
      require(topic.values[c].size() == topic.time_ns.size(), "there is one value per time stamp");
      values += topic.values[c].size();
    }
  }
  require(values <= bytes, "no more values than bytes in the log");
  if (values > 10'000) return;
  const auto table = join(*std::move(signals), "a");
  if (!table) return;
  for (std::size_t row = 1; row < table->lines.size(); ++row) {
    require(table->columns[0].value[row] > table->columns[0].value[row - 1],
            "time increases from row to row");
  }
}

}  // namespace awmr::fuzz
