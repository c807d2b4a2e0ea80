/// Helpers of the readers of trial files (surge.cpp, turning.cpp, coastdown.cpp, log.cpp). Private
/// to this folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/read_trials.h"

namespace awmr {

/// Access to the cells of one file by row and column. Collects the faults found in them.
class TrialReader {
 public:
  TrialReader(CsvTable table, const TrialOptions& options)
      : table_(std::move(table)), options_(options) {}

  const CsvTable& table() const { return table_; }
  bool has(std::string_view column) const { return table_.has(column); }
  /// Moves the values of a column out of the table; the column is empty afterwards.
  std::vector<double> take(std::string_view column) { return table_.take(column); }
  /// Returns the value of a cell; empty if the file has no such column or the cell is empty.
  std::optional<double> cell(std::size_t row, std::string_view column) const;
  /// Like cell(); also adds a fault if the value is negative.
  std::optional<double> non_negative(std::size_t row, std::string_view column);

  /// Adds a fault at the cell of this row and column; header_fault() adds one at the header.
  void fault(ErrorCode code, std::size_t row, std::string_view column, std::string message);
  void header_fault(ErrorCode code, std::string message);
  std::vector<Fault>& faults() { return faults_; }

  /// Returns a finding with the file and the line of this row.
  Finding finding(std::size_t row, Severity severity, std::string code, std::string message) const;

  /// Call last_place() and rounding_error() of agreement.h for a column of this file.
  double last_place(std::string_view column) const;
  double rounding_error(double printed, std::string_view column) const;

 private:
  CsvTable table_;
  const TrialOptions& options_;
  std::vector<Fault> faults_;
};

/// A speed or yaw rate that a row can give as a printed value, as a timed value, or both. Timed
/// value: `per_amount` times the cell of `amount_column` over the cell of `elapsed_s`.
struct Rate {
  std::string_view printed_column;  ///< column of the printed value: "speed_mps"
  std::string_view amount_column;   ///< column of the distance or number of turns: "turns"
  double per_amount = 1.0;          ///< 1 for distance_m, 2 pi (rad) for turns
  std::string code;                 ///< code of the finding if the two values disagree
};

/// Speed or yaw rate of one row, with the distance or number of turns and the time that determine
/// it.
struct RateInRow {
  /// The rate to use, m/s or rad/s, >= 0. If the row has a printed and a timed value, the option
  /// `preference` selects one of them. 0 if the row has neither.
  double used = 0.0;
  /// Distance, m, or number of turns; absent unless elapsed_s > 0.
  std::optional<double> amount;
  std::optional<double> elapsed_s;  ///< elapsed time, s; absent unless > 0
};

/// Returns the rate of a row; empty on a fault. Adds a finding if the printed and the timed value
/// disagree (agreement.h). Adds a fault if a value is negative, or if elapsed_s is 0 although the
/// row has a rate or an amount.
std::optional<RateInRow> rate_of(TrialReader& reader, std::size_t row, const Rate& rate,
                                 std::optional<double> printed, Preference preference,
                                 std::vector<Finding>& findings);

/// Adds the notes of the table (how its format and columns were interpreted) to the findings.
void note_format(const TrialReader& reader, std::vector<Finding>& findings);

/// Lists the lines of these rows in the file: "line 4", "lines 4, 7, 9". Names at most twelve
/// lines, then the number of further lines: "... and 3 more". Precondition: `rows` is not empty.
std::string lines_of(const TrialReader& reader, std::span<const std::size_t> rows);

/// Adds the note `rows-set-aside`, which lists the lines of the unused `rows` and the reason `why`.
/// Adds nothing if `rows` is empty.
void note_rows_set_aside(const TrialReader& reader, std::span<const std::size_t> rows,
                         std::string_view why, std::vector<Finding>& findings);

}  // namespace awmr
