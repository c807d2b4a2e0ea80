/// Detects time columns with names other than `t_s` if the name or the cells are unambiguous: with
/// a unit (`time_ms`); whole seconds and nanoseconds (`stamp.sec`, `stamp.nanosec`); ISO 8601
/// dates; if nothing else is found, seconds since 1970 with a fraction. Private to the library.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace awmr {

/// Column required in every time series.
inline constexpr std::string_view kTimeName = "t_s";

/// From this value on, s, a time is a clock time and is counted from the first row.
inline constexpr double kClockTime_s = 1e6;

struct TimeColumn {
  std::string expression;  ///< over the header's columns, s
  bool is_date = false;    ///< the cells are dates, and the expression is the column's name
  bool is_pair = false;    ///< whole seconds first, then nanoseconds below 1e9
  std::string meaning;     ///< description for messages
};

/// `samples`: cells of the first row, as text; none: dates are not detected. Nothing if no column
/// is a time. Error: more than one is, as text that names them.
tl::expected<std::optional<TimeColumn>, std::string> find_time(
    std::span<const std::string> header, std::span<const std::string> samples);

/// Seconds since 1970 of `2026-01-31T12:34:56.789Z`. A space can replace the T, and `+hh:mm` the Z.
/// Without a zone, UTC is assumed: only differences matter, and a change to summer time would
/// appear as a jump. Seconds and their fraction are optional. Nothing if the form differs.
std::optional<double> seconds_of_date(std::string_view text);

}  // namespace awmr
