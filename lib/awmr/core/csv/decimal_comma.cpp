#include "awmr/core/csv/decimal_comma.h"

#include <fmt/format.h>

#include <algorithm>

#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

/// True for texts such as 1,250 or -12,500, whose comma may be a thousands separator.
bool may_be_thousands(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  const std::size_t comma = text.find(',');
  return comma >= 1 && comma <= 3 && text[0] != '0' && text.size() == comma + 4 &&
         std::all_of(text.begin() + static_cast<std::ptrdiff_t>(comma) + 1, text.end(), is_digit);
}

}  // namespace

std::optional<double> number_with_comma(const CsvCell& cell, DecimalCommas& seen) {
  const std::size_t comma = cell.text.find(',');
  if (comma == std::string_view::npos || cell.text.find('.') != std::string_view::npos) {
    return std::nullopt;
  }
  std::string text(cell.text);
  text[comma] = '.';
  const auto value = number_from_text(text);
  if (!value) return std::nullopt;
  if (!seen.comma) seen.comma = cell;
  if (!may_be_thousands(cell.text)) seen.unmistakable = true;
  return *value;
}

void note_point(const CsvCell& cell, DecimalCommas& seen) {
  if (!seen.point && cell.text.find('.') != std::string_view::npos) seen.point = cell;
}

std::optional<std::string> fault_of(const DecimalCommas& seen) {
  if (!seen.comma) return std::nullopt;
  const std::string text = shortened(seen.comma->text, 40);
  if (seen.point) {
    return fmt::format(
        "found \"{}\" with a comma, and \"{}\" with a point in line {}: write all numbers "
        "with a point",
        text, shortened(seen.point->text, 40), seen.point->line);
  }
  if (seen.unmistakable) return std::nullopt;
  return fmt::format(
      "the comma in \"{}\" may be a decimal comma or a thousands separator; write numbers with a "
      "point",
      text);
}

}  // namespace awmr
