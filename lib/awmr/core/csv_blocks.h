/// Reads a CSV file in blocks, with several threads if it is large. Handles ordinary numeric tables
/// of any length. Private to the library.
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

/// Performance settings. They do not change the table.
struct CsvBlocks {
  std::size_t bytes = std::size_t{1} << 18U;  ///< per block; text and numbers fit into the cache
  int threads = 0;                            ///< 0: one for a small file, else up to four
  bool hash = true;  ///< compute the hash that identifies the file in outputs
};

/// Returns the same table as read_csv_text(), or nothing if read_csv_text() must read the file: it
/// has a fault, a quoted cell spans lines, a carriage return alone ends a line, or numbers have
/// decimal commas. Records the hash of the file. Errors: the file cannot be read or is modified
/// while it is read.
Result<std::optional<CsvTable>> read_csv_blocks(std::shared_ptr<const InputBytes> bytes,
                                                std::span<const CsvColumn> columns,
                                                std::span<const ColumnMapping> mappings,
                                                const CsvBlocks& blocks = {});

}  // namespace awmr
