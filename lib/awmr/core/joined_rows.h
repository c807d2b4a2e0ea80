/// Tables whose columns have values at times of their own: which of their rows are kept. Private to the
/// library.
#pragma once

#include <vector>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv.h"

namespace awmr {

/// Drops the rows without a value of any column and those before every command is known; a note says
/// how many.
void drop_rows(CsvTable::Parts& parts, const ColumnSources& sources);

/// A column without a value in any row is a fault.
void refuse_void_columns(const CsvTable::Parts& parts, const ColumnSources& sources,
                         std::vector<Fault>& faults);

}  // namespace awmr
