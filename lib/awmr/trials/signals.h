/// Signals with times of their own, as flight controllers and robots log them, and how they become
/// one table. Private to this folder.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/raw_table.h"
#include "awmr/core/result.h"

namespace awmr {

/// The messages of one topic, in the order of the file.
struct Topic {
  std::string name;
  std::vector<std::int64_t> time_ns = {};
  std::vector<std::size_t> columns = {};         ///< indices into the header
  std::vector<std::vector<double>> values = {};  ///< of each column, by message
};

/// A file's signals: all their names, `TOPIC.FIELD`, and the values of those that were wanted.
struct Signals {
  std::vector<std::string> header = {};
  std::vector<Topic> topics = {};
  std::vector<CsvNote> notes = {};
};

/// Whether a signal's values are asked for.
using Wanted = std::function<bool(const std::string& name)>;

/// More signals than this are not taken from one file.
inline constexpr std::size_t kMostSignals = 200'000;

/// One row for every time at which some topic has a message, each value in its own row and nowhere
/// else; the first column is t_s, counted from the first row. NaN stands for no value, as in uORB,
/// and is noted. Errors: no messages; the time of a topic does not rise; an infinite value.
Result<RawTable> join(Signals signals, const std::string& file);

}  // namespace awmr
