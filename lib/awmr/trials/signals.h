/// Signals with their own times, as logged by flight controllers and robots, and their conversion
/// to one table. Private to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/raw_table.h"
#include "awmr/core/result.h"

namespace awmr {

/// Messages of one topic, in file order.
struct Topic {
  std::string name;
  std::vector<std::int64_t> time_ns = {};
  std::vector<std::size_t> columns = {};         ///< indices into the header
  std::vector<std::vector<double>> values = {};  ///< by column, then by message
};

/// Signals of a file: the names of all, `TOPIC.FIELD`, and the values of the requested ones.
struct Signals {
  std::vector<std::string> header = {};
  std::vector<Topic> topics = {};
  std::vector<CsvNote> notes = {};
};

/// True if a signal's values are requested.
using Wanted = std::function<bool(const std::string& name)>;

/// Maximum number of signals per file.
inline constexpr std::size_t kMostSignals = 200'000;

/// Creates one row for every time at which some topic has a message. Each value is in its own row
/// only. The first column is t_s, counted from the first row. NaN means no value, as in uORB, and
/// is noted. Errors: no messages; the time of a topic does not rise; an infinite value.
Result<RawTable> join(Signals signals, const std::string& file);

}  // namespace awmr
