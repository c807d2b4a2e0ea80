/// Signals from several tables with one topic each. Private to this folder.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "signals.h"

namespace awmr {

/// Signals read from several tables, and the mappings that gave their times.
struct CsvTopics {
  Signals signals = {};
  std::vector<std::size_t> mapped = {};
};

/// Names a column `FILE.COLUMN`, without the file's extension, or by its own name if no other file
/// has it. Each file has a time column, t_s or one that replaces it, and all share one clock.
/// Errors: as read_csv(); the files have no time in common.
Result<CsvTopics> read_csv_topics(std::span<const std::filesystem::path> paths,
                                  std::span<const ColumnMapping> mappings, const Wanted& wanted);

}  // namespace awmr
