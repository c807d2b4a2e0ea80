#include "awmr/core/csv/time_column.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <vector>

#include "awmr/core/containers.h"
#include "awmr/core/name_table.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

/// Splits a name into lower-case words: `Header.Stamp_ns` gives header, stamp, ns.
std::vector<std::string> parts_of(std::string_view name) {
  std::vector<std::string> parts(1);
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      parts.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!parts.back().empty()) {
      parts.emplace_back();
    }
  }
  if (parts.size() > 1 && parts.back().empty()) parts.pop_back();
  return parts;
}

constexpr std::array<Named<double>, 16> kUnits{{{"s", 1.0},
                                                {"sec", 1.0},
                                                {"secs", 1.0},
                                                {"seconds", 1.0},
                                                {"ms", 1e-3},
                                                {"msec", 1e-3},
                                                {"millis", 1e-3},
                                                {"milliseconds", 1e-3},
                                                {"us", 1e-6},
                                                {"usec", 1e-6},
                                                {"micros", 1e-6},
                                                {"microseconds", 1e-6},
                                                {"ns", 1e-9},
                                                {"nsec", 1e-9},
                                                {"nanos", 1e-9},
                                                {"nanoseconds", 1e-9}}};

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return contains(words, word);
}

bool is_time_word(std::string_view word) {
  return is_one_of(word, {"t", "time", "timestamp", "stamp"});
}

std::string in_backticks(const std::string& name) { return "`" + name + "`"; }

/// Recognises names such as `time_ms` and `header.stamp [us]`, but not `stop_time_s`, which is a
/// duration.
std::optional<TimeColumn> with_unit(const std::string& name) {
  // PlotJuggler exports seconds under this name.
  if (name == "__time") {
    return TimeColumn{.expression = in_backticks(name), .meaning = "\"__time\" in s"};
  }
  const std::vector<std::string> parts = parts_of(name);
  if (parts.size() < 2 || !is_time_word(parts[parts.size() - 2])) return std::nullopt;
  const bool is_stamp = is_one_of(parts[parts.size() - 2], {"timestamp", "stamp"});
  if (parts.size() > 2 && !is_stamp) return std::nullopt;
  const auto unit = value_in(kUnits, parts.back());
  if (!unit) return std::nullopt;
  return TimeColumn{.expression = fmt::format("{}*{}", in_backticks(name), *unit),
                    .meaning = fmt::format("\"{}\" in {}", name, parts.back())};
}

/// Recognises a time in two columns, seconds in `stamp.sec` and nanoseconds in `stamp.nanosec`.
std::optional<TimeColumn> with_nanoseconds(const std::string& name,
                                           std::span<const std::string> header) {
  std::vector<std::string> parts = parts_of(name);
  if (!is_one_of(parts.back(), {"sec", "secs"})) return std::nullopt;
  for (const std::string& other : header) {
    const std::vector<std::string> its = parts_of(other);
    if (!is_one_of(its.back(), {"nanosec", "nanosecs", "nsec", "nsecs"})) continue;
    parts.back() = its.back();
    if (parts != its) continue;
    return TimeColumn{
        .expression = fmt::format("{} + {}*1e-9", in_backticks(name), in_backticks(other)),
        .is_pair = true,
        .meaning = fmt::format("\"{}\" and \"{}\", seconds and nanoseconds", name, other)};
  }
  return std::nullopt;
}

std::optional<TimeColumn> as_date(const std::string& name, std::string_view sample) {
  const std::string word = parts_of(name).back();
  if (!is_time_word(word) && !is_one_of(word, {"date", "datetime", "utc"})) return std::nullopt;
  if (!seconds_of_date(sample)) return std::nullopt;
  return TimeColumn{
      .expression = name, .is_date = true, .meaning = fmt::format("the dates of \"{}\"", name)};
}

/// Recognises a column such as `timestamp` with seconds since 1970, of the years 2001 to 2096. The
/// number must have a fraction, which distinguishes it from a count of milliseconds or smaller
/// units.
std::optional<TimeColumn> as_unix_seconds(const std::string& name, std::string_view sample) {
  if (!is_time_word(parts_of(name).back()) || sample.find('.') == std::string_view::npos) {
    return std::nullopt;
  }
  double seconds = 0.0;
  const auto [end, error] = std::from_chars(sample.data(), sample.data() + sample.size(), seconds);
  if (error != std::errc() || end != sample.data() + sample.size()) return std::nullopt;
  if (!(seconds >= 1e9 && seconds <= 4e9)) return std::nullopt;
  return TimeColumn{.expression = in_backticks(name),
                    .meaning = fmt::format("\"{}\" in s since 1970", name)};
}

/// Removes a number of `digits` digits from the front and returns it; empty if there is none.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
  int value = 0;
  if (text.size() < digits) return std::nullopt;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + digits, value);
  if (error != std::errc() || stop != text.data() + digits || text[0] == '-') return std::nullopt;
  text.remove_prefix(digits);
  return value;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text[0] != c) return false;
  text.remove_prefix(1);
  return true;
}

/// Removes a fraction such as `.789` or `,789` from the front. Returns its value; 0 if there is
/// none.
std::optional<double> take_fraction(std::string_view& text) {
  if (!take(text, '.') && !take(text, ',')) return 0.0;
  double value = 0.0;
  double place = 0.1;
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text[0])) == 0) return std::nullopt;
  while (!text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) != 0) {
    value += place * (text[0] - '0');
    place /= 10.0;
    text.remove_prefix(1);
  }
  return value;
}

/// Removes a time zone (`Z`, `+hh:mm`, `-hhmm` or nothing). Returns its offset from UTC, s; empty
/// if it is invalid.
std::optional<int> take_zone(std::string_view& text) {
  if (text.empty() || take(text, 'Z')) return 0;
  const int sign = text[0] == '-' ? -1 : 1;
  if (!take(text, '+') && !take(text, '-')) return std::nullopt;
  const auto hours = take_digits(text, 2);
  take(text, ':');
  const auto minutes = text.empty() ? std::optional<int>(0) : take_digits(text, 2);
  if (!hours || !minutes || *hours > 14 || *minutes > 59) return std::nullopt;
  return sign * (3600 * *hours + 60 * *minutes);
}

/// Removes a clock time `hh:mm[:ss[.fff]]`. Returns the seconds since midnight; empty if it is
/// invalid.
std::optional<double> take_clock(std::string_view& text) {
  const auto hours = take_digits(text, 2);
  if (!hours || *hours > 23 || !take(text, ':')) return std::nullopt;
  const auto minutes = take_digits(text, 2);
  if (!minutes || *minutes > 59) return std::nullopt;
  const double until_minute = 3600.0 * *hours + 60.0 * *minutes;
  if (!take(text, ':')) return until_minute;
  const auto seconds = take_digits(text, 2);
  const auto fraction = seconds ? take_fraction(text) : std::nullopt;
  if (!seconds || *seconds > 59 || !fraction) return std::nullopt;
  return until_minute + *seconds + *fraction;
}

}  // namespace

std::optional<double> seconds_of_date(std::string_view text) {
  const auto year = take_digits(text, 4);
  if (!year || !take(text, '-')) return std::nullopt;
  const auto month = take_digits(text, 2);
  if (!month || !take(text, '-')) return std::nullopt;
  const auto day = take_digits(text, 2);
  if (!day || (!take(text, 'T') && !take(text, ' '))) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  const auto clock = take_clock(text);
  const auto zone_s = clock ? take_zone(text) : std::nullopt;
  if (!clock || !zone_s || !text.empty()) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + *clock - *zone_s;
}

tl::expected<std::optional<TimeColumn>, std::string> find_time(
    std::span<const std::string> header, std::span<const std::string> samples) {
  std::vector<TimeColumn> found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    auto one = with_nanoseconds(header[i], header);
    if (!one) one = with_unit(header[i]);
    // A unit in the name takes precedence over a date in the first row.
    if (!one && i < samples.size()) one = as_date(header[i], samples[i]);
    if (one) found.push_back(*std::move(one));
  }
  if (found.empty()) {
    for (std::size_t i = 0; i < std::min(header.size(), samples.size()); ++i) {
      if (auto one = as_unix_seconds(header[i], samples[i])) found.push_back(*std::move(one));
    }
  }
  if (found.empty()) return std::nullopt;
  if (found.size() == 1) return std::move(found.front());
  // A pair of seconds and nanoseconds is one time, even if each of its columns is a candidate too.
  for (const TimeColumn& pair : found) {
    const auto is_part = [&](const TimeColumn& other) {
      const std::size_t star = other.expression.find('*');
      return pair.expression.find(other.expression.substr(0, star)) != std::string::npos;
    };
    std::size_t parts = 0;
    for (const TimeColumn& other : found) parts += is_part(other) ? 1U : 0U;
    if (pair.is_pair && parts == found.size()) return pair;
  }
  std::string names;
  for (const TimeColumn& one : found) names += (names.empty() ? "" : ", or ") + one.meaning;
  return tl::unexpected(fmt::format("the time may be {}", shortened(names, 300)));
}

}  // namespace awmr
