/// Selects the rows to keep in tables whose columns have different sample times. Private to the
/// library.
#pragma once

#include <vector>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv.h"

namespace awmr {

/// Drops rows without any value and rows before every command is known; a note gives their number.
void drop_rows(CsvTable::Parts& parts, const ColumnSources& sources);

/// Reports each column without any value as a fault.
void refuse_void_columns(const CsvTable::Parts& parts, const ColumnSources& sources,
                         std::vector<Fault>& faults);

}  // namespace awmr
