/// Drops unusable rows of tables with signals of different rates. Private to the library.
#pragma once

#include <vector>

#include "awmr/core/column_sources.h"
#include "awmr/core/csv.h"

namespace awmr {

/// For a log with signals of different rates: drops the rows that a fit cannot use. These are the
/// rows in which every column that may have empty cells is empty (columns other than
/// EmptyCells::kFault, csv.h), and all rows at the beginning of the log until each command (kHeld)
/// has had its first value. Adds the note `joined-by-time` with the numbers of rows kept and
/// dropped.
void drop_rows(CsvTable::Parts& parts, const ColumnSources& sources);

/// Adds a fault for each requested column that is empty in all rows, except for columns that may be
/// absent (EmptyCells::kOptional).
void refuse_void_columns(const CsvTable::Parts& parts, const ColumnSources& sources,
                         std::vector<Fault>& faults);

}  // namespace awmr
