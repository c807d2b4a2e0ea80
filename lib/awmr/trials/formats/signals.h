/// Signals of different rates, as flight controllers and ROS 2 log them, and their conversion to
/// one table. Private to trials/.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv/raw_table.h"
#include "awmr/core/result.h"

namespace awmr {

/// Messages of one topic, in file order, with the fields that were requested.
struct Topic {
  std::string name;
  std::vector<std::int64_t> time_ns = {};  ///< time of each message
  std::vector<std::size_t> columns = {};   ///< requested signals: indices in Signals::header
  /// For each requested signal: one value per message.
  std::vector<std::vector<double>> values = {};
};

/// Signals of a file.
struct Signals {
  std::vector<std::string> header = {};  ///< names of all signals: `TOPIC.FIELD`
  std::vector<Topic> topics = {};        ///< topics, each with the values of the requested signals
  std::vector<CsvNote> notes = {};
};

/// Function that selects signals: true if the values of the signal `name` are requested.
using Wanted = std::function<bool(const std::string& name)>;

/// Adds a signal with this name to the last topic of `signals`. Returns true if its values are
/// requested; the topic then has a column for them.
bool add_signal(std::string name, const Wanted& wanted, Signals& signals);

/// Maximum number of signals per file.
inline constexpr std::size_t kMaxSignals = 200'000;

/// Converts signals to a table with one row for every time at which a topic with requested signals
/// has a message. A row has only the values of messages at its time; nothing is interpolated. The
/// first column is t_s, counted from the first row. NaN counts as an empty cell, as in PX4's uORB,
/// with a note. Errors: times that do not rise within a topic; an infinite value.
Result<RawTable> join(Signals signals, const std::string& file);

}  // namespace awmr
