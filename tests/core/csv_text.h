/// Reads CSV from a text instead of a file.
#pragma once

#include <string_view>
#include <vector>

#include "awmr/core/csv.h"
#include "support/scratch_file.h"

namespace awmr::testing {

inline Result<CsvTable> read_text(std::string_view text, const std::vector<CsvColumn>& columns,
                                  const std::vector<ColumnMapping>& mappings = {}) {
  const ScratchFile file("a.csv", text);
  return read_csv(file.path(), columns, mappings);
}

}  // namespace awmr::testing
