/// A CSV file that is read in blocks, by several threads where it is large: what an ordinary table of
/// numbers takes, however long it is. Private to the library.
///
///     the file   |  block 0  |  block 1  |  block 2  | ...     any thread reads one of them
///     its lines  header|-----|-----|----|------|-----          a line counts where it begins
///     the table  rows of 0, rows of 1, rows of 2 ...           taken in the file's order
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "awmr/core/csv.h"
#include "awmr/core/input_bytes.h"

namespace awmr {

/// None of it changes the table.
struct CsvBlocks {
  std::size_t bytes = std::size_t{1} << 18U;  ///< of a block; text and numbers stay in the cache
  int threads = 0;                            ///< 0: one for a small file, else up to four
  bool hash = true;  ///< takes the hash of a file, by which outputs name it
};

/// The table as read_csv_text() gives it, or nothing where that has to read the file: something is
/// wrong with it, a quoted cell goes over several lines, a carriage return alone ends a line, or
/// numbers have decimal commas. Notes the hash of a file. Errors: the file cannot be read or is
/// written to meanwhile.
Result<std::optional<CsvTable>> read_csv_blocks(std::shared_ptr<const InputBytes> bytes,
                                                std::span<const CsvColumn> columns,
                                                std::span<const ColumnMapping> mappings,
                                                const CsvBlocks& blocks = {});

}  // namespace awmr
