/// Parses and writes CSV cells: numbers and text.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace awmr {

/// Removes leading and trailing spaces and tabs.
inline std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Parses a finite decimal number; a leading '+' is allowed. Errors, as text with the remedy: an
/// empty cell, NaN, infinity, a hexadecimal number, a decimal comma, a unit after the number, a
/// number out of range, any other text.
tl::expected<double, std::string> number_from_text(std::string_view text);

/// Returns text as a CSV cell, quoted if necessary. A text that begins with = + - @, a tab or a
/// carriage return gets a leading apostrophe, because a spreadsheet would run it as a formula. So
/// does a text that begins with an apostrophe: a reader can then always remove one.
std::string cell_of_text(std::string_view text);

/// Removes the first record (row) from `csv` and returns its cells as text, without the quotation
/// marks and apostrophes of cell_of_text(). A quoted cell can contain line ends. Detects no faults,
/// so use it only for text that this program wrote.
std::vector<std::string> take_text_record(std::string_view& csv);

}  // namespace awmr
