/// Reads a directory of CSV files, one topic per file, as signals. Private to this folder.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "signals.h"

namespace awmr {

/// Signals of several CSV files.
struct CsvTopics {
  Signals signals = {};
  /// Indices in `mappings` of the mappings to t_s that were used.
  std::vector<std::size_t> mapped = {};
};

/// Reads the files as signals. A signal has the name `FILE.COLUMN` (FILE without extension). If
/// only one file has the column, the signal also has the name `COLUMN`. Each file needs a time
/// column: t_s, the source of a mapping to t_s, or one that find_time() recognises. All files must
/// use the same clock. Errors: those of read_csv(); files that do not overlap in time; a time of
/// more than 9e9 s.
Result<CsvTopics> read_csv_topics(std::span<const std::filesystem::path> paths,
                                  std::span<const ColumnMapping> mappings, const Wanted& wanted);

}  // namespace awmr
