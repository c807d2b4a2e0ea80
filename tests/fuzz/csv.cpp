/// Fuzz target: reads the bytes as a CSV table. The reader returns finite values or a readable
/// error.
#include <cmath>

#include "awmr/core/csv.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const awmr::CsvColumn columns[] = {{"t_s"}, {"speed_mps", false}, {"run", false}};
  const awmr::ColumnMapping mappings[] = {{"speed_mps", "V (m/s)", 2.0, 1.0}};
  const auto table =
      awmr::read_csv_text(awmr::fuzz::text_of(data, size), "a.csv", columns, mappings);
  if (!table) {
    require(!table.error().faults.empty(), "an error has at least one fault");
    require(awmr::to_text(table.error()).size() < 100'000, "the error text is short");
    return 0;
  }
  require(table->rows() > 0, "a table has rows");
  for (const awmr::CsvColumn& column : columns) {
    if (!table->has(column.name)) continue;
    require(table->column(column.name).size() == table->rows(), "a column has one value per row");
    for (const double value : table->column(column.name)) {
      require(std::isfinite(value), "a value is finite");
    }
  }
  for (std::size_t row = 1; row < table->rows(); ++row) {
    require(table->line(row) > table->line(row - 1), "line numbers increase");
  }
  return 0;
}
