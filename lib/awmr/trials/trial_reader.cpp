#include "trial_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "awmr/core/csv.h"
#include "awmr/trials/checks/agreement.h"

namespace awmr {

std::optional<double> TrialReader::cell(std::size_t row, std::string_view column) const {
  if (!table_.has(column)) return std::nullopt;
  const std::vector<bool>& present = table_.present(column);
  if (!present.empty() && !present[row]) return std::nullopt;
  return table_.column(column)[row];
}

std::optional<double> TrialReader::non_negative(std::size_t row, std::string_view column) {
  const std::optional<double> value = cell(row, column);
  if (value && *value < 0.0) {
    fault(ErrorCode::kOutOfRange, row, column,
          fmt::format("{} must not be negative, found {}", column, *value));
  }
  return value;
}

void TrialReader::fault(ErrorCode code, std::size_t row, std::string_view column,
                        std::string message) {
  faults_.push_back({code, table_.place(row, column), std::move(message)});
}

void TrialReader::header_fault(ErrorCode code, std::string message) {
  faults_.push_back({code, table_.header_place(), std::move(message)});
}

Finding TrialReader::finding(std::size_t row, Severity severity, std::string code,
                             std::string message) const {
  return {finding_file(table_), table_.line(row), severity, std::move(code), std::move(message)};
}

double TrialReader::last_place(std::string_view column) const {
  return awmr::last_place(table_, column, options_.columns);
}

double TrialReader::rounding_error(double printed, std::string_view column) const {
  return awmr::rounding_error(printed, last_place(column));
}

namespace {

Finding mismatch(const TrialReader& reader, std::size_t row, const Rate& rate, double printed,
                 double timed, double tolerance, Preference preference) {
  const double amount = *reader.cell(row, rate.amount_column);
  const double elapsed_s = *reader.cell(row, "elapsed_s");
  const bool use_printed = preference == Preference::kPrinted;
  return reader.finding(
      row, Severity::kWarning, rate.code,
      fmt::format(
          "{} is {}, but {} {} in elapsed_s {} gives {:.4g}: the two values differ by {:.2g}, "
          "but rounding and timing explain only {:.2g}; the {} value {:.4g} is used (a fit "
          "with errors on the time uses elapsed_s unchanged)",
          rate.printed_column, printed, rate.amount_column, amount, elapsed_s, timed,
          std::abs(printed - timed), tolerance, use_printed ? "printed" : "timed",
          use_printed ? printed : timed));
}

}  // namespace

std::optional<RateInRow> rate_of(TrialReader& reader, std::size_t row, const Rate& rate,
                                 std::optional<double> printed, Preference preference,
                                 std::vector<Finding>& findings) {
  const std::size_t faults_before = reader.faults().size();
  const auto amount = reader.non_negative(row, rate.amount_column);
  const auto elapsed_s = reader.non_negative(row, "elapsed_s");
  if (reader.faults().size() > faults_before) return std::nullopt;
  const bool counted = amount && elapsed_s;
  if (!counted) return RateInRow{printed.value_or(0.0), {}, {}};

  if (*elapsed_s == 0.0) {
    // elapsed_s may be 0 only in a row at rest: the printed rate is 0 or, without a printed rate,
    // the distance or number of turns is 0.
    const double motion = printed.value_or(*amount);
    if (motion != 0.0) {
      reader.fault(ErrorCode::kOutOfRange, row, "elapsed_s",
                   fmt::format("elapsed_s is 0 in a row with motion ({} {}); give the elapsed time",
                               printed ? rate.printed_column : rate.amount_column, motion));
      return std::nullopt;
    }
    return RateInRow{};
  }
  const double timed = rate.per_amount * *amount / *elapsed_s;
  if (!std::isfinite(timed) || (timed == 0.0 && *amount > 0.0)) {
    reader.fault(ErrorCode::kOutOfRange, row, "elapsed_s",
                 fmt::format("{} {} in elapsed_s {} gives the rate {}, which is impossible; "
                             "correct the wrong value",
                             rate.amount_column, *amount, *elapsed_s, timed));
    return std::nullopt;
  }
  if (!printed) return RateInRow{timed, amount, elapsed_s};

  const double tolerance = reader.rounding_error(*printed, rate.printed_column) +
                           timing_error(timed, *elapsed_s, reader.last_place("elapsed_s"));
  if (std::abs(*printed - timed) > tolerance) {
    findings.push_back(mismatch(reader, row, rate, *printed, timed, tolerance, preference));
  }
  return RateInRow{preference == Preference::kPrinted ? *printed : timed, amount, elapsed_s};
}

void note_format(const TrialReader& reader, std::vector<Finding>& findings) {
  for (const CsvNote& note : reader.table().notes) {
    findings.push_back(
        {finding_file(reader.table()), note.line, Severity::kNote, note.code, note.message});
  }
}

std::string lines_of(const TrialReader& reader, std::span<const std::size_t> rows) {
  constexpr std::size_t kMaxNamed = 12;
  std::string lines = rows.size() == 1 ? "line " : "lines ";
  for (std::size_t i = 0; i < rows.size() && i < kMaxNamed; ++i) {
    lines += fmt::format("{}{}", i == 0 ? "" : ", ", reader.table().line(rows[i]));
  }
  if (rows.size() > kMaxNamed) lines += fmt::format(" and {} more", rows.size() - kMaxNamed);
  return lines;
}

void note_rows_set_aside(const TrialReader& reader, std::span<const std::size_t> rows,
                         std::string_view why, std::vector<Finding>& findings) {
  if (rows.empty()) return;
  findings.push_back(
      reader.finding(rows.front(), Severity::kNote, "rows-set-aside",
                     fmt::format("{} of {} rows are not used ({}): {}", rows.size(),
                                 reader.table().rows(), lines_of(reader, rows), why)));
}

}  // namespace awmr
