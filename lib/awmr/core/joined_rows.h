/// Drops unusable rows of tables with signals of different rates. Private to the library.
#pragma once

#include <vector>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv.h"

namespace awmr {

/// Drops the rows in which no kHeld, kAbsent or kOptional column has a value, and the rows before
/// every command (kHeld) has had a value. Adds the note `joined-by-time` with the numbers of rows
/// kept and dropped.
void drop_rows(CsvTable::Parts& parts, const ColumnSources& sources);

/// Adds a fault for each requested column without a value in any row, except for kOptional columns.
void refuse_void_columns(const CsvTable::Parts& parts, const ColumnSources& sources,
                         std::vector<Fault>& faults);

}  // namespace awmr
