/// Tables with one topic each, as signals. Private to this folder.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "signals.h"

namespace awmr {

/// Signals read from several tables, and which mappings gave their times.
struct CsvTopics {
  Signals signals = {};
  std::vector<std::size_t> mapped = {};
};

/// A column is called `FILE.COLUMN`, without the file's extension, and by its own name where no other
/// file has it. Each file has a time, t_s or what stands for it, and all have one clock. Errors: as
/// read_csv(); no time that all files share.
Result<CsvTopics> read_csv_topics(std::span<const std::filesystem::path> paths,
                                  std::span<const ColumnMapping> mappings, const Wanted& wanted);

}  // namespace awmr
