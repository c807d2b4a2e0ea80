#include "awmr/core/csv/raw_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

/// If at least this fraction of the cells of a command (kHeld) or a measurement (kAbsent) is empty,
/// the table counts as one with signals of different rates. In other tables, such an empty cell is
/// a fault.
constexpr double kSparseShare = 0.25;

bool is_empty(double value) { return std::isnan(value); }
bool has_value(double value) { return std::isfinite(value); }

/// True for a command (kHeld) or a measurement (kAbsent), whose cells may be empty in a table with
/// signals of different rates.
bool has_own_rate(const ColumnSource& source) {
  return source.column.empty == EmptyCells::kHeld || source.column.empty == EmptyCells::kAbsent;
}

/// True if the table is sparse, that is, has signals of different rates (kSparseShare).
bool is_sparse(const RawTable& raw, const ColumnSources& sources) {
  if (raw.joined) return true;
  const double rows = static_cast<double>(raw.lines.size());
  for (const ColumnSource& source : sources.found) {
    if (!has_own_rate(source)) continue;
    for (const std::size_t index : source.indices) {
      const std::vector<double>& value = raw.columns[index].value;
      const auto empty = std::count_if(value.begin(), value.end(), is_empty);
      if (static_cast<double>(empty) >= kSparseShare * rows && empty > 0) return true;
    }
  }
  return false;
}

int character_of(const RawTable& raw, const ColumnSource& source, std::size_t row) {
  if (source.indices.empty()) return 1;
  const std::vector<int>& character = raw.columns[source.indices.front()].character;
  return character.empty() ? 1 : character[row];
}

/// Collects up to kMaxFaults faults with their places.
struct FaultList {
  const RawTable& raw;
  std::vector<Fault>& faults;

  bool full() const { return faults.size() >= kMaxFaults; }
  void add(ErrorCode code, std::size_t row, int character, std::string message) {
    if (full()) return;
    faults.push_back(
        {code, fmt::format("{}:{}:{}", raw.file, raw.lines[row], character), std::move(message)});
  }
};

/// Adds a fault if `value`, the value of a requested column in a row, is infinite or NaN. `inputs`:
/// values of the file's columns from which it was computed.
void check_value(double value, const ColumnSource& source, std::span<const double> inputs,
                 std::size_t row, FaultList& faults) {
  if (std::isfinite(value)) return;
  if (!source.expression) {
    faults.add(ErrorCode::kOutOfRange, row, character_of(faults.raw, source, row),
               fmt::format("column {}: out of range after scaling; check the scale and offset of "
                           "its mapping",
                           source.column.name));
    return;
  }
  std::string at;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    at += fmt::format("{}{} = {}", i == 0 ? " with " : ", ",
                      shortened(source.expression->names()[i], 60), inputs[i]);
  }
  faults.add(ErrorCode::kOutOfRange, row, character_of(faults.raw, source, row),
             fmt::format("column {}: {} is {}{}", source.column.name,
                         shortened(source.mapping != nullptr ? source.mapping->expression
                                                             : source.time->expression,
                                   200),
                         std::isnan(value) ? "not a number" : "infinite", at));
}

/// Index of the formula's column with the most values. In a table of signals with different rates,
/// the formula is evaluated in the rows that have a value of this column, with the latest values of
/// the other columns.
std::size_t fastest(const RawTable& raw, const ColumnSource& source) {
  const auto count = [&](std::size_t index) {
    return std::ranges::count_if(raw.columns[index].value, has_value);
  };
  const auto best = std::ranges::max_element(source.indices, {}, count);
  return static_cast<std::size_t>(best - source.indices.begin());
}

/// Replaces missing values by the previous value of the column, and before the first value by the
/// first value.
void hold(CsvTable::Column& column) {
  const auto first = std::find(column.present.begin(), column.present.end(), true);
  if (first == column.present.end()) return;
  double held = column.values[static_cast<std::size_t>(first - column.present.begin())];
  for (std::size_t row = 0; row < column.values.size(); ++row) {
    if (column.present[row]) held = column.values[row];
    column.values[row] = held;
  }
}

double value_of(ColumnSource& source, std::span<const double> inputs) {
  if (source.expression) return (*source.expression)(inputs);
  return source.mapping == nullptr ? inputs.front() : inputs.front() * source.scale + source.offset;
}

/// Checks a time that is given as seconds and nanoseconds. Adds a fault if the seconds are not
/// whole, or if the nanoseconds are outside [0, 1e9).
void check_pair(const ColumnSource& source, std::span<const double> inputs, std::size_t row,
                FaultList& faults) {
  if (!source.time || !source.time->is_pair) return;
  if (inputs[0] == std::floor(inputs[0]) && inputs[1] >= 0.0 && inputs[1] < 1e9) return;
  faults.add(ErrorCode::kAmbiguous, row, character_of(faults.raw, source, row),
             fmt::format("{}: expected whole seconds and nanoseconds below 1e9, found {} and {}; "
                         "define the time: {}",
                         source.time->meaning, inputs[0], inputs[1],
                         option_text("column t_s=EXPRESSION")));
}

/// For each column of the file, the number of requested columns that are computed from it.
std::vector<int> uses_of(const RawTable& raw, const ColumnSources& sources) {
  std::vector<int> uses(raw.columns.size(), 0);
  for (const ColumnSource& source : sources.found) {
    for (const std::size_t index : source.indices) ++uses[index];
  }
  return uses;
}

/// Storage for the values of a requested column. To save memory, this is the storage of a file
/// column that the requested column is computed from, if no other requested column still needs it.
std::vector<double> storage_for(const ColumnSource& source, const std::vector<int>& uses,
                                RawTable& raw) {
  for (const std::size_t index : source.indices) {
    if (uses[index] == 0) return std::move(raw.columns[index].value);
  }
  return std::vector<double>(raw.lines.size());
}

/// Computes a requested column. `uses`: for each file column, the number of other requested columns
/// that still need it. `sparse`: the column may have empty cells.
CsvTable::Column column_of(ColumnSource& source, const std::vector<int>& uses, bool sparse,
                           RawTable& raw, FaultList& faults) {
  // In a table with one row per run (kOptional), a formula must not use cells of other rows.
  const bool keeps_previous = sparse && source.column.empty != EmptyCells::kOptional;
  const std::size_t rows = raw.lines.size();
  CsvTable::Column column;
  if (!source.indices.empty()) column.character = raw.columns[source.indices.front()].character;
  if (sparse) column.present.resize(rows, true);
  const std::size_t driver = sparse ? fastest(raw, source) : 0;
  std::vector<std::span<const double>> cells;
  for (const std::size_t index : source.indices) cells.emplace_back(raw.columns[index].value);
  column.values = storage_for(source, uses, raw);
  std::vector<double> inputs(source.indices.size(), kEmptyCell);
  for (std::size_t row = 0; row < rows && !faults.full(); ++row) {
    bool driven = true;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double value = cells[i][row];
      if (!keeps_previous || has_value(value)) inputs[i] = value;
      if (keeps_previous && i == driver) driven = has_value(value);
    }
    const bool has_all = driven && std::all_of(inputs.begin(), inputs.end(), has_value);
    column.values[row] = has_all ? value_of(source, inputs) : 0.0;
    if (has_all) {
      check_value(column.values[row], source, inputs, row, faults);
      check_pair(source, inputs, row, faults);
    } else if (sparse) {
      column.present[row] = false;
    }
  }
  for (const std::size_t index : source.indices) {
    if (uses[index] == 0) raw.columns[index].value = {};
  }
  if (!sparse) return column;
  hold(column);
  if (std::all_of(column.present.begin(), column.present.end(), [](bool p) { return p; })) {
    column.present.clear();
  }
  return column;
}

/// Completes a time column that find_time() found, or that has dates. If it begins with a date or a
/// clock time (kClockTime_s), subtracts this first time from all. Adds the note `time-column`.
void settle_time(const ColumnSource& source, CsvTable& table) {
  if (!source.time) return;
  std::vector<double>& t_s = table.columns.at(source.column.name).values;
  const double first = t_s.empty() ? 0.0 : t_s.front();
  const bool is_clock = std::abs(first) >= kClockTime_s || source.time->is_date;
  if (is_clock) {
    for (double& t : t_s) t -= first;
    table.clock_s = first;
  }
  table.notes.push_back({0, "time-column",
                         fmt::format("t_s is taken from {}{}", source.time->meaning,
                                     is_clock ? ", counted from the first row" : "")});
}

/// Adds a fault for each empty cell of a requested column that must have a value in every row.
void find_empty_cells(const ColumnSource& source, FaultList& faults) {
  for (const std::size_t index : source.indices) {
    const RawColumn& column = faults.raw.columns[index];
    for (std::size_t row = 0; row < column.value.size() && !faults.full(); ++row) {
      if (!is_empty(column.value[row])) continue;
      faults.add(ErrorCode::kMissing, row, column.character.empty() ? 1 : column.character[row],
                 fmt::format("column {}: the cell is empty; expected a number; leave out rows "
                             "without a measured value",
                             source.column.name));
    }
  }
}

/// Removes kOptional columns without any value.
void drop_void_columns(CsvTable& table, const ColumnSources& sources) {
  for (const ColumnSource& source : sources.found) {
    if (source.column.empty != EmptyCells::kOptional) continue;
    if (is_void(table.columns.at(source.column.name))) table.columns.erase(source.column.name);
  }
}

/// Adds the columns of `sources` to the table. `sparse`: signals of different rates, so that a cell
/// may be empty.
void take_columns(RawTable& raw, ColumnSources& sources, std::span<const ColumnMapping> mappings,
                  bool sparse, FaultList& list, CsvTable& table) {
  const auto may_be_empty = [sparse](const ColumnSource& source) {
    return (sparse && has_own_rate(source)) || source.column.empty == EmptyCells::kOptional;
  };
  std::vector<int> uses = uses_of(raw, sources);
  for (ColumnSource& source : sources.found) {
    if (!may_be_empty(source)) find_empty_cells(source, list);
    if (source.mapping != nullptr) {
      table.mapped.push_back(static_cast<std::size_t>(source.mapping - mappings.data()));
    } else if (!may_be_empty(source) && !source.expression) {
      continue;
    }
    for (const std::size_t index : source.indices) --uses[index];
    table.columns.emplace(source.column.name,
                          column_of(source, uses, may_be_empty(source), raw, list));
  }
  // Columns that are used unchanged are moved out of `raw` last: the columns above are computed
  // from them.
  for (const ColumnSource& source : sources.found) {
    if (source.mapping != nullptr || source.expression || may_be_empty(source)) continue;
    RawColumn& column = raw.columns[source.indices.front()];
    table.columns.emplace(source.column.name,
                          CsvTable::Column{.values = std::move(column.value),
                                           .character = std::move(column.character)});
  }
}

}  // namespace

Result<CsvTable> table_of(RawTable raw, ColumnSources sources,
                          std::span<const ColumnMapping> mappings, std::vector<Fault> faults) {
  const bool sparse = is_sparse(raw, sources);
  FaultList list{raw, faults};
  CsvTable table{.file = raw.file, .header_line = raw.header_line, .mapped = std::move(raw.mapped)};
  take_columns(raw, sources, mappings, sparse, list, table);
  drop_void_columns(table, sources);
  table.lines = std::move(raw.lines);
  table.notes = std::move(raw.notes);
  for (const ColumnSource& source : sources.found) {
    settle_time(source, table);
  }
  if (sparse) refuse_void_columns(table, sources, faults);
  if (sparse && faults.empty()) drop_rows(table, sources);
  if (faults.empty() && table.lines.empty()) {
    faults.push_back({ErrorCode::kTooFewData, table.header_place(),
                      sparse ? "no row has a value of a command or measurement; record these "
                               "signals, or map other columns"
                             : "there are no rows below the header; add at least one"});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return table;
}

}  // namespace awmr
