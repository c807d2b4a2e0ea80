/// Time under other names than `t_s`, where the name or the cells leave no doubt: with a unit
/// (`time_ms`), as whole seconds and nanoseconds (`stamp.sec`, `stamp.nanosec`), as dates of ISO
/// 8601, as seconds since 1970 with a fraction where there is no other. Private to the library.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace awmr {

/// The column that every time series has.
inline constexpr std::string_view kTimeName = "t_s";

/// From this value on, s, a time is that of a clock: it is counted from the first row.
inline constexpr double kClockTime_s = 1e6;

struct TimeColumn {
  std::string expression;  ///< of the header's columns, s
  bool is_date = false;    ///< the cells are dates, and the expression is the column's name
  bool is_pair = false;    ///< whole seconds first, then nanoseconds below 1e9
  std::string meaning;     ///< for a person
};

/// `samples` are the cells of the first row, as texts; none: no dates are looked for. Nothing where
/// no column is one of time. Error: more than one is, as a text that names them.
tl::expected<std::optional<TimeColumn>, std::string> find_time(
    std::span<const std::string> header, std::span<const std::string> samples);

/// Seconds since 1970 of `2026-01-31T12:34:56.789Z`: a space may stand for the T, `+hh:mm` for the Z
/// or nothing (then it is taken as UTC: differences count, and a change to summer time would show as
/// a jump); seconds and their fraction may be absent. Nothing where it is not of that form.
std::optional<double> seconds_of_date(std::string_view text);

}  // namespace awmr
