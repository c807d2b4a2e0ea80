#include <algorithm>
#include <system_error>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/input_file.h"
#include "awmr/trials/column_guess.h"
#include "awmr/trials/formats/read_table.h"
#include "awmr/trials/log_files.h"
#include "awmr/trials/trial_columns.h"

namespace awmr {
namespace {

namespace fs = std::filesystem;

Result<FileSample> sample_of_text(std::string_view bytes, const std::string& file) {
  AWMR_ASSIGN_OR_RETURN(CsvHead head,
                        csv_head(bytes, file, columns_of(TrialKind::kLog), {}, kSampleRows));
  FileSample sample{.names = std::move(head.names), .values = {}, .texts = {}};
  sample.values.resize(sample.names.size());
  sample.texts.resize(sample.names.size());
  for (const std::vector<std::string>& row : head.rows) {
    for (std::size_t i = 0; i < std::min(row.size(), sample.names.size()); ++i) {
      if (sample.texts[i].empty()) sample.texts[i] = row[i];
      std::string text = row[i];
      if (head.delimiter != ',') std::replace(text.begin(), text.end(), ',', '.');
      if (const auto value = number_from_text(text)) sample.values[i].push_back(*value);
    }
  }
  return sample;
}

FileSample sample_of_signals(const Signals& signals) {
  FileSample sample{.names = signals.header, .values = {}, .texts = {}};
  sample.values.resize(sample.names.size());
  for (const Topic& topic : signals.topics) {
    for (std::size_t c = 0; c < topic.columns.size(); ++c) {
      const std::size_t count = std::min(topic.values[c].size(), kSampleRows);
      sample.values[topic.columns[c]].assign(
          topic.values[c].begin(), topic.values[c].begin() + static_cast<std::ptrdiff_t>(count));
    }
  }
  return sample;
}

FileSample sample_of_columns(ColumnLog log) {
  FileSample sample{.names = std::move(log.header), .values = std::move(log.columns), .texts = {}};
  sample.texts.resize(sample.names.size());
  for (std::vector<double>& values : sample.values) {
    values.resize(std::min(values.size(), kSampleRows));
  }
  return sample;
}

/// Sample of a directory of tables; a column is named `FILE.COLUMN`.
Result<FileSample> sample_of_tables(const std::vector<fs::path>& paths) {
  FileSample all;
  for (const fs::path& path : paths) {
    AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
    AWMR_ASSIGN_OR_RETURN(FileSample one, sample_of_text(bytes, path.string()));
    for (std::size_t i = 0; i < one.names.size(); ++i) {
      all.names.push_back(path.stem().string() + "." + one.names[i]);
      all.values.push_back(std::move(one.values[i]));
      all.texts.push_back(std::move(one.texts[i]));
    }
  }
  return all;
}

}  // namespace

Result<FileSample> sample_of(const fs::path& path) {
  const Wanted all = [](const std::string&) { return true; };
  AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> paths, files_of(path));
  std::error_code error;
  if (fs::is_directory(path, error) && paths.front().extension() == ".csv") {
    return sample_of_tables(paths);
  }
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(paths.front()));
  if (auto log = read_columns(bytes, paths.front().string())) {
    if (!*log) return tl::unexpected(std::move(*log).error());
    return sample_of_columns(std::move(**log));
  }
  const auto signals = read_signals(bytes, paths.front().string(), all);
  if (!signals) return sample_of_text(bytes, path.string());
  if (!*signals) return tl::unexpected(signals->error());
  return sample_of_signals(**signals);
}

}  // namespace awmr
