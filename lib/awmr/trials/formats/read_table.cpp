#include "read_table.h"

#include <algorithm>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/csv.h"
#include "awmr/core/csv/column_sources.h"
#include "awmr/core/csv/raw_table.h"
#include "awmr/core/csv/time_column.h"
#include "awmr/core/input_file.h"
#include "awmr/trials/awl.h"
#include "awmr/trials/log_files.h"

namespace awmr {
namespace {

namespace fs = std::filesystem;

/// Finds the requested columns in `raw`, whose columns have the names `header`.
Result<CsvTable> requested_columns(RawTable raw, const std::vector<std::string>& header,
                                   std::span<const CsvColumn> columns,
                                   std::span<const ColumnMapping> mappings) {
  ColumnSources sources = find_columns(header, {}, columns, mappings, raw.file);
  std::vector<Fault> faults;
  for (HeaderFault& fault : sources.faults) {
    faults.push_back({fault.code, raw.file, std::move(fault.message)});
  }
  return table_of(std::move(raw), std::move(sources), mappings, std::move(faults));
}

Result<CsvTable> table_of_signals(CsvTopics topics, const std::string& file,
                                  std::span<const CsvColumn> columns,
                                  std::span<const ColumnMapping> mappings) {
  std::vector<std::string> header{std::string(kTimeName)};
  append(header, topics.signals.header);
  AWMR_ASSIGN_OR_RETURN(RawTable raw, join(std::move(topics.signals), file));
  raw.mapped = std::move(topics.mapped);
  return requested_columns(std::move(raw), header, columns, mappings);
}

Result<CsvTable> table_of_columns(ColumnLog log, const std::string& file,
                                  std::span<const CsvColumn> columns,
                                  std::span<const ColumnMapping> mappings) {
  RawTable raw{.file = file};
  raw.lines.append(1, log.rows());
  for (std::vector<double>& column : log.columns) raw.columns.push_back({std::move(column)});
  raw.notes = std::move(log.notes);
  return requested_columns(std::move(raw), log.header, columns, mappings);
}

Result<ColumnLog> columns_of_awl(std::string_view bytes, const std::string& file) {
  AWMR_ASSIGN_OR_RETURN(AwlLog log, read_awl(bytes, file));
  ColumnLog columns{.header = std::move(log.header), .columns = std::move(log.columns)};
  for (Finding& finding : log.findings) {
    columns.notes.push_back({finding.line, std::move(finding.code), std::move(finding.message)});
  }
  return columns;
}

/// Appends the signals of the next file of a split bag; topics with the same name become one topic.
void join(Signals part, Signals& all) {
  std::vector<std::size_t> places;
  for (const std::string& name : part.header) {
    const auto found = std::find(all.header.begin(), all.header.end(), name);
    places.push_back(static_cast<std::size_t>(found - all.header.begin()));
    if (found == all.header.end()) all.header.push_back(name);
  }
  for (Topic& topic : part.topics) {
    for (std::size_t& column : topic.columns) column = places[column];
    const auto known = std::find_if(all.topics.begin(), all.topics.end(), [&](const Topic& other) {
      return other.name == topic.name && other.columns == topic.columns;
    });
    if (known == all.topics.end()) {
      all.topics.push_back(std::move(topic));
      continue;
    }
    append(known->time_ns, topic.time_ns);
    for (std::size_t c = 0; c < topic.values.size(); ++c) {
      append(known->values[c], topic.values[c]);
    }
  }
  append(all.notes, part.notes);
}

Result<Signals> read_bags(std::span<const fs::path> paths, const Wanted& wanted) {
  Signals all;
  for (const fs::path& path : paths) {
    AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
    AWMR_ASSIGN_OR_RETURN(Signals part, read_rosbag(bytes, path.string(), wanted));
    join(std::move(part), all);
  }
  return all;
}

}  // namespace

std::optional<Result<Signals>> read_signals(std::string_view bytes, const std::string& file,
                                            const Wanted& wanted) {
  if (is_ulog(bytes)) return read_ulog(bytes, file, wanted);
  if (is_dataflash(bytes)) return read_dataflash(bytes, file, wanted);
  if (is_dataflash_text(bytes)) return read_dataflash_text(bytes, file, wanted);
  if (is_rosbag(bytes)) return read_rosbag(bytes, file, wanted);
  return std::nullopt;
}

std::optional<Result<ColumnLog>> read_columns(std::string_view bytes, const std::string& file) {
  if (is_awl(bytes)) return columns_of_awl(bytes, file);
  if (is_sysid(bytes)) return read_sysid(bytes, file);
  return std::nullopt;
}

/// Names the directory as the place of the faults of its common table, which has no lines.
tl::unexpected<Error> in_directory(Error error, const std::string& directory) {
  for (Fault& fault : error.faults) {
    if (fault.place != directory && !fault.place.starts_with(directory + ":")) continue;
    fault.place = directory;
    fault.message = "this directory is read as one recording: " + fault.message;
  }
  return tl::unexpected(std::move(error));
}

Result<CsvTable> read_table(const fs::path& path, std::span<const CsvColumn> columns,
                            const TrialOptions& options) {
  const std::string file = path.string();
  const Wanted wanted = [names = wanted_names(columns, options.columns)](const std::string& name) {
    return names.count(name) != 0;
  };
  std::error_code error;
  if (fs::is_directory(path, error)) {
    AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> paths, files_of(path));
    CsvTopics topics;
    if (paths.front().extension() == ".db3") {
      AWMR_ASSIGN_OR_RETURN(topics.signals, read_bags(paths, wanted));
    } else {
      AWMR_ASSIGN_OR_RETURN(topics, read_csv_topics(paths, options.columns, wanted));
    }
    auto table = table_of_signals(std::move(topics), file, columns, options.columns);
    if (!table) return in_directory(std::move(table).error(), file);
    return table;
  }
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
  if (auto log = read_columns(bytes, file)) {
    if (!*log) return tl::unexpected(std::move(*log).error());
    return table_of_columns(std::move(**log), file, columns, options.columns);
  }
  auto signals = read_signals(bytes, file, wanted);
  if (!signals) return read_csv_text(bytes, file, columns, options.columns);
  if (!*signals) return tl::unexpected(std::move(*signals).error());
  return table_of_signals({.signals = std::move(**signals), .mapped = {}}, file, columns,
                          options.columns);
}

}  // namespace awmr
