#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/csv/time_column.h"
#include "awmr/core/input_file.h"
#include "log_formats.h"

namespace awmr {
namespace {

struct File {
  std::string path;
  std::string stem;
  std::string text;
  std::vector<std::string> header;
};

/// The column mappings that define t_s.
struct TimeMappings {
  std::vector<ColumnMapping> mappings = {};
  /// For each element of `mappings`: its index in the list of all mappings.
  std::vector<std::size_t> places = {};
};

TimeMappings time_mappings(std::span<const ColumnMapping> mappings) {
  TimeMappings times;
  for (std::size_t i = 0; i < mappings.size(); ++i) {
    if (mappings[i].name != kTimeName) continue;
    times.mappings.push_back(mappings[i]);
    times.places.push_back(i);
  }
  return times;
}

const CsvColumn kTime{std::string(kTimeName), true};

Result<std::vector<File>> read_files(std::span<const std::filesystem::path> paths,
                                     const TimeMappings& times) {
  std::vector<File> files;
  for (const std::filesystem::path& path : paths) {
    File file{.path = path.string(), .stem = path.stem().string(), .text = {}, .header = {}};
    AWMR_ASSIGN_OR_RETURN(file.text, read_input(path));
    AWMR_ASSIGN_OR_RETURN(CsvHead head,
                          csv_head(file.text, file.path, std::span(&kTime, 1), times.mappings, 0));
    file.header = std::move(head.names);
    files.push_back(std::move(file));
  }
  return files;
}

std::map<std::string, int> counts_of(const std::vector<File>& files) {
  std::map<std::string, int> counts;
  for (const File& file : files) {
    for (const std::string& name : file.header) ++counts[name];
  }
  return counts;
}

/// First and last time of a file's rows, s.
struct Span {
  const File* file = nullptr;
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// Error if a file begins after another file has ended.
Status check_spans(const std::vector<Span>& spans) {
  if (spans.empty()) return {};
  const auto last = std::max_element(spans.begin(), spans.end(), [](const Span& a, const Span& b) {
    return a.begin_s < b.begin_s;
  });
  const auto first = std::min_element(
      spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.end_s < b.end_s; });
  if (last->begin_s <= first->end_s) return {};
  return input_error(
      ErrorCode::kWrongOrder, last->file->path,
      fmt::format("begins at {:.9g} s, after {} has ended at {:.9g} s: files that are joined must "
                  "share one clock; correct the times, or give each file as a log of its own",
                  last->begin_s, first->file->path, first->end_s));
}

void note_zero_starts(const std::vector<Span>& spans, std::vector<CsvNote>& notes) {
  const bool all_at_zero =
      spans.size() > 1 &&
      std::all_of(spans.begin(), spans.end(), [](const Span& span) { return span.begin_s == 0.0; });
  if (!all_at_zero) return;
  notes.push_back(
      {0, "one-clock",
       "the times of all files begin at exactly 0, and awmr takes them as times of "
       "one clock. If each file counts from its own first row, the signals of the files "
       "are shifted in time: correct the times"});
}

/// Returns a column of a table as a topic, with the rows that have a value.
Topic topic_of(const CsvTable& table, const std::string& column, std::size_t place) {
  Topic topic{.name = column, .columns = {place}, .values = {{}}};
  const std::vector<bool>& present = table.present(column);
  const std::span<const double> t_s = table.column(kTimeName);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!present.empty() && !present[row]) continue;
    topic.time_ns.push_back(std::llround(1e9 * (t_s[row] + table.clock_s)));
    topic.values[0].push_back(table.column(column)[row]);
  }
  return topic;
}

/// Error if a time does not fit into 64-bit nanoseconds (9e9 s, the year 2255 in clock time).
Status check_time(const CsvTable& table) {
  constexpr double kMax_s = 9e9;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (std::abs(table.column(kTimeName)[row] + table.clock_s) > kMax_s) {
      return input_error(ErrorCode::kOutOfRange, table.place(row, kTimeName),
                         "too large for a time in seconds; convert it with a mapping of t_s");
    }
  }
  return {};
}

/// Adds the names of one file's columns, and the values of the requested ones.
Status add_file(const File& file, const std::map<std::string, int>& counts,
                const TimeMappings& times, const Wanted& wanted, CsvTopics& topics,
                std::vector<Span>& spans) {
  std::vector<CsvColumn> requested{kTime};
  std::vector<std::size_t> places;
  for (const std::string& name : file.header) {
    if (name == kTimeName) continue;
    std::vector<std::string> called{file.stem + "." + name};
    if (counts.at(name) == 1) called.push_back(name);
    for (std::string& one : called) {
      topics.signals.header.push_back(std::move(one));
      if (!wanted(topics.signals.header.back())) continue;
      requested.push_back({name, true, EmptyCells::kAbsent});
      places.push_back(topics.signals.header.size() - 1);
    }
  }
  if (places.empty()) return {};
  AWMR_ASSIGN_OR_RETURN(const CsvTable table,
                        read_csv_text(file.text, file.path, requested, times.mappings));
  AWMR_RETURN_IF_ERROR(check_time(table));
  for (std::size_t i = 0; i < places.size(); ++i) {
    topics.signals.topics.push_back(topic_of(table, requested[i + 1].name, places[i]));
  }
  for (const std::size_t used : table.mapped) topics.mapped.push_back(times.places[used]);
  for (const CsvNote& note : table.notes) {
    if (note.code == "joined-by-time") continue;
    topics.signals.notes.push_back({note.line, note.code, file.stem + ": " + note.message});
  }
  const std::span<const double> t_s = table.column(kTimeName);
  spans.push_back({&file, t_s.front() + table.clock_s, t_s.back() + table.clock_s});
  return {};
}

}  // namespace

Result<CsvTopics> read_csv_topics(std::span<const std::filesystem::path> paths,
                                  std::span<const ColumnMapping> mappings, const Wanted& wanted) {
  const TimeMappings times = time_mappings(mappings);
  AWMR_ASSIGN_OR_RETURN(const std::vector<File> files, read_files(paths, times));
  const std::map<std::string, int> counts = counts_of(files);
  CsvTopics topics;
  std::vector<Span> spans;
  for (const File& file : files) {
    AWMR_RETURN_IF_ERROR(add_file(file, counts, times, wanted, topics, spans));
  }
  AWMR_RETURN_IF_ERROR(check_spans(spans));
  note_zero_starts(spans, topics.signals.notes);
  return topics;
}

}  // namespace awmr
