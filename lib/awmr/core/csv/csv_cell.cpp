#include "awmr/core/csv/csv_cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "awmr/core/csv.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::size_t kLongestCell = 40;  ///< number of characters of a cell that a message shows

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return result;
}

/// The text of a cell for a message: in quotes, shortened, on one line.
std::string shown(std::string_view text) {
  const std::string_view begin = first_characters(text, kLongestCell);
  std::string result(begin);
  std::replace_if(
      result.begin(), result.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, ' ');
  return fmt::format("\"{}{}\"", result, begin.size() < text.size() ? "..." : "");
}

bool is_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  return comma != std::string_view::npos && text.find(',', comma + 1) == std::string_view::npos &&
         std::any_of(text.begin(), text.end(), is_digit) &&
         text.find_first_not_of("+-0123456789,eE") == std::string_view::npos;
}

std::size_t count_digits(std::string_view text) {
  return static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) -
                                  text.begin());
}

/// True if the text begins with a date such as 2026-01-31, 31.01.2026 or 1/31/26.
bool is_date(std::string_view text) {
  const std::size_t first = count_digits(text);
  if (first == 0 || first >= text.size()) return false;
  const char separator = text[first];
  if (separator != '-' && separator != '.' && separator != '/') return false;
  text.remove_prefix(first + 1);
  const std::size_t second = count_digits(text);
  if (second == 0 || second > 2 || second >= text.size() || text[second] != separator) return false;
  const std::size_t third = count_digits(text.substr(second + 1));
  return first == 4 ? third == 1 || third == 2 : first <= 2 && (third == 2 || third == 4);
}

/// True if the text begins with a clock time such as 12:34.
bool is_clock_time(std::string_view text) {
  const std::size_t hours = count_digits(text);
  return hours > 0 && hours <= 2 && text.substr(hours).starts_with(':') &&
         count_digits(text.substr(hours + 1)) == 2;
}

/// The Unicode minus sign U+2212, which some programs write in place of '-'.
constexpr std::string_view kMinusSign = "\xE2\x88\x92";

/// Message for a text that is not a number. `read`: length, in bytes, of the number at its
/// beginning, as in `12 km`; 0 if there is none.
std::string why_not_a_number(std::string_view text, std::size_t read) {
  const std::size_t sign = text.find_first_not_of("+-");
  const std::string word = sign == std::string_view::npos ? "" : lower(text.substr(sign));
  std::string found = fmt::format("expected a number, found {}", shown(text));
  if (!is_utf8(text)) return found + ", which is not UTF-8 (Latin-1?); save the file as UTF-8";
  if (is_date(text) || is_clock_time(text)) {
    return fmt::format(
        "{}, a {}; write seconds as a number, or dates like 2026-01-31T12:34:56.789Z in one column "
        "called time",
        found, is_date(text) ? "date" : "clock time");
  }
  if (word.rfind("nan", 0) == 0) return found + "; leave out rows without a measured value";
  if (word == "inf" || word == "infinity") {
    return found + "; leave out rows without a finite value";
  }
  if (word.rfind("0x", 0) == 0) return found + ": hexadecimal; write it in decimal";
  if (is_decimal_comma(text)) {
    std::string point(text);
    std::replace(point.begin(), point.end(), ',', '.');
    return fmt::format("{} with a decimal comma; write {} with a point", found, point);
  }
  if (read > 0 && read < text.size() && !is_digit(text[read])) {
    return found + "; write only the number in the cell, and its unit in the column's name";
  }
  return found;
}

std::optional<double> number_with_minus_sign(std::string_view text) {
  std::string ascii(text);
  std::size_t at = ascii.find(kMinusSign);
  if (at == std::string::npos) return std::nullopt;
  for (; at != std::string::npos; at = ascii.find(kMinusSign)) {
    ascii.replace(at, kMinusSign.size(), "-");
  }
  const auto number = number_from_text(ascii);
  return number ? std::optional(*number) : std::nullopt;
}

}  // namespace

tl::expected<double, std::string> number_from_text(std::string_view text) {
  text = trimmed(text);
  if (text.empty())
    return tl::unexpected(std::string(
        "the cell is empty; expected a number; leave out rows without a measured value"));
  std::string_view digits = text;
  if (digits.size() > 1 && digits[0] == '+' && (is_digit(digits[1]) || digits[1] == '.')) {
    digits.remove_prefix(1);
  }
  double value = 0.0;
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error == std::errc::result_out_of_range && stop == end) {
    return tl::unexpected(shown(text) + " is out of range: largest 1.8e308, smallest 2.3e-308");
  }
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    if (const auto number = number_with_minus_sign(text)) return *number;
    const auto read = error == std::errc() ? static_cast<std::size_t>(stop - text.data()) : 0U;
    return tl::unexpected(why_not_a_number(text, read));
  }
  return value;
}

std::string cell_of_text(std::string_view text) {
  constexpr std::string_view kFormulaBegins = "=+-@\t\r'";
  const bool guarded = !text.empty() && kFormulaBegins.find(text[0]) != std::string_view::npos;
  std::string cell = guarded ? "'" : "";
  if (text.find_first_of(",;\t\"#\r\n") == std::string_view::npos) return cell.append(text);
  cell.insert(0, 1, '"');
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell + '"';
}

std::vector<std::string> take_text_record(std::string_view& csv) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  std::size_t i = 0;
  for (; i < csv.size() && (quoted || csv[i] != '\n'); ++i) {
    const bool doubled = quoted && csv.substr(i, 2) == "\"\"";
    if (doubled) ++i;
    if (csv[i] == '"' && !doubled) {
      quoted = !quoted;
    } else if (csv[i] == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += csv[i];
    }
  }
  csv.remove_prefix(std::min(i + 1, csv.size()));
  for (std::string& cell : cells) {
    if (cell.starts_with('\'')) cell.erase(0, 1);
  }
  return cells;
}

std::string format_number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace awmr
