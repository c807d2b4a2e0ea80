/// Common to the readers of the three trial files. Private to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/read_trials.h"

namespace awmr {

/// Cells of one file, and the faults found in them.
class TrialReader {
 public:
  TrialReader(CsvTable table, const TrialOptions& options)
      : table_(std::move(table)), options_(options) {}

  const CsvTable& table() const { return table_; }
  bool has(std::string_view column) const { return table_.has(column); }
  /// Same as CsvTable::take().
  std::vector<double> take(std::string_view column) { return table_.take(column); }
  /// Returns the cell; empty if the file has no such column or the row leaves it empty.
  std::optional<double> cell(std::size_t row, std::string_view column) const;
  /// Like cell(); a negative value is a fault.
  std::optional<double> non_negative(std::size_t row, std::string_view column);

  void fault(ErrorCode code, std::size_t row, std::string_view column, std::string message);
  void header_fault(ErrorCode code, std::string message);
  std::vector<Fault>& faults() { return faults_; }

  Finding finding(std::size_t row, Severity severity, std::string code, std::string message) const;

  double last_place(std::string_view column) const;
  double rounding_error(double printed, std::string_view column) const;

 private:
  CsvTable table_;
  const TrialOptions& options_;
  std::vector<Fault> faults_;
};

/// A quantity printed in `printed_column` and timed as `amount` over `elapsed_s` in the same row.
struct Rate {
  std::string_view printed_column;  ///< "speed_mps"
  std::string_view amount_column;   ///< "distance_m", "turns"
  double per_amount = 1.0;          ///< 2 pi rad in a turn
  std::string code;                 ///< code of the finding if the two disagree
};

struct RateInRow {
  double used = 0.0;
  std::optional<double> amount;  ///< only if the row was timed: elapsed_s > 0
  std::optional<double> elapsed_s;
};

/// Returns the rate of a row, as magnitudes. Adds a finding if its two values disagree, and a fault
/// if a value is negative or motion takes no time. Empty on a fault.
std::optional<RateInRow> rate_of(TrialReader& reader, std::size_t row, const Rate& rate,
                                 std::optional<double> printed, Preference preference,
                                 std::vector<Finding>& findings);

/// Adds the table's notes on its detected format to the findings.
void note_format(const TrialReader& reader, std::vector<Finding>& findings);

/// "line 4", "lines 4, 7, 9" for the table's rows, not empty; beyond twelve "... and 3 more".
std::string lines_of(const TrialReader& reader, std::span<const std::size_t> rows);

/// Adds the note that reports which rows were set aside.
void note_rows_set_aside(const TrialReader& reader, std::span<const std::size_t> rows,
                         std::string_view why, std::vector<Finding>& findings);

}  // namespace awmr
