/// Finds the time column of a file that has no column `t_s`. It recognises a name with a unit
/// (`time_ms`), whole seconds with nanoseconds (`stamp.sec`, `stamp.nanosec`), and dates of ISO
/// 8601. If there is none of these, it looks for seconds since 1970 with a fraction. Private to the
/// library.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace awmr {

/// Name of the time column, s.
inline constexpr std::string_view kTimeName = "t_s";

/// Smallest magnitude of a clock time, such as seconds since 1970, s. If the time column that
/// find_time() found begins with a clock time, times are counted from the first row.
inline constexpr double kClockTime_s = 1e6;

/// A column or a pair of columns with the time.
struct TimeColumn {
  std::string expression;  ///< formula over the file's columns that gives the time, s
  bool is_date = false;    ///< true: the cells are dates, and `expression` is the column's name
  bool is_pair = false;    ///< true: a column of whole seconds and one of nanoseconds below 1e9
  std::string meaning;     ///< description for messages
};

/// Finds the time among the columns of a header. `samples`: cells of the first row; if empty, dates
/// and seconds since 1970 are not found. Empty if no column is a time. Error: a text that names the
/// candidates, if there is more than one.
tl::expected<std::optional<TimeColumn>, std::string> find_time(
    std::span<const std::string> header, std::span<const std::string> samples);

/// Converts a date such as `2026-01-31T12:34:56.789Z` to seconds since 1970; empty for other text.
/// A space may replace the T, and `+hh:mm` the Z. Seconds and their fraction are optional. Without
/// a zone, UTC is assumed: a wrong zone does no harm, because only differences of times matter.
std::optional<double> seconds_of_date(std::string_view text);

}  // namespace awmr
