#include "signals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/csv/time_column.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

Status check(const Topic& topic, const Signals& signals, const std::string& file) {
  std::vector<Fault> faults;
  const auto fault = [&](ErrorCode code, std::size_t message, std::string text) {
    if (faults.size() >= kMaxFaults) return;
    faults.push_back(
        {code, file,
         fmt::format("message {} of {}: {}", message + 1, shortened(topic.name, 100), text)});
  };
  for (std::size_t i = 1; i < topic.time_ns.size(); ++i) {
    if (topic.time_ns[i] > topic.time_ns[i - 1]) continue;
    fault(ErrorCode::kWrongOrder, i,
          fmt::format("its time changes by {:.3g} s from the message before; time must increase "
                      "within a topic: split the file where the time restarts",
                      1e-9 * (static_cast<double>(topic.time_ns[i]) -
                              static_cast<double>(topic.time_ns[i - 1]))));
    break;
  }
  for (std::size_t c = 0; c < topic.columns.size(); ++c) {
    for (std::size_t i = 0; i < topic.values[c].size(); ++i) {
      if (std::isinf(topic.values[c][i])) {
        fault(ErrorCode::kOutOfRange, i,
              fmt::format("{} is infinite", signals.header[topic.columns[c]]));
      }
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

/// Sorted distinct times, ns, of all topics with requested signals.
std::vector<std::int64_t> times_of(const std::vector<Topic>& topics) {
  std::vector<std::int64_t> times;
  for (const Topic& topic : topics) {
    if (!topic.columns.empty()) {
      append(times, topic.time_ns);
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

void place(const Topic& topic, const std::vector<std::int64_t>& times, RawTable& raw) {
  for (std::size_t c = 0; c < topic.columns.size(); ++c) {
    std::vector<double>& column = raw.columns[topic.columns[c] + 1].value;
    column.assign(times.size(), kEmptyCell);
    auto row = times.begin();
    for (std::size_t i = 0; i < topic.time_ns.size(); ++i) {
      row = std::lower_bound(row, times.end(), topic.time_ns[i]);
      column[static_cast<std::size_t>(row - times.begin())] = topic.values[c][i];
    }
  }
}

void note_missing(const Topic& topic, const Signals& signals, std::vector<CsvNote>& notes) {
  for (std::size_t c = 0; c < topic.columns.size(); ++c) {
    const auto missing = std::count_if(topic.values[c].begin(), topic.values[c].end(),
                                       [](double value) { return std::isnan(value); });
    if (missing == 0) continue;
    notes.push_back(
        {0, "missing-values",
         fmt::format("{} is not a number (NaN) in {} of {} messages; these messages count as "
                     "messages without this value",
                     signals.header[topic.columns[c]], missing, topic.values[c].size())});
  }
}

}  // namespace

bool add_signal(std::string name, const Wanted& wanted, Signals& signals) {
  signals.header.push_back(std::move(name));
  if (!wanted(signals.header.back())) return false;
  signals.topics.back().columns.push_back(signals.header.size() - 1);
  signals.topics.back().values.emplace_back();
  return true;
}

Result<RawTable> join(Signals signals, const std::string& file) {
  RawTable raw{.file = file, .joined = true};
  raw.notes = std::move(signals.notes);
  raw.columns.resize(signals.header.size() + 1);
  for (const Topic& topic : signals.topics) {
    if (topic.columns.empty()) continue;
    AWMR_RETURN_IF_ERROR(check(topic, signals, file));
    note_missing(topic, signals, raw.notes);
  }
  const std::vector<std::int64_t> times = times_of(signals.topics);
  raw.lines.append(1, times.size());
  for (std::size_t row = 0; row < times.size(); ++row) {
    // Unsigned, because the difference of two signed 64-bit times could overflow.
    const std::uint64_t since =
        static_cast<std::uint64_t>(times[row]) - static_cast<std::uint64_t>(times[0]);
    raw.columns[0].value.push_back(1e-9 * static_cast<double>(since));
  }
  for (Topic& topic : signals.topics) {
    place(topic, times, raw);
    topic = {};
  }
  return raw;
}

}  // namespace awmr
