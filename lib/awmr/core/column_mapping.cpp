#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/csv_cell.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::string_view kForm = "expected NAME=SOURCE[*SCALE][+OFFSET]";

/// Takes a number off the front of `text`; nothing where none is there.
std::optional<double> take_number(std::string_view& text) {
  std::string_view digits = trimmed(text);
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  digits.remove_prefix(static_cast<std::size_t>(stop - digits.data()));
  text = trimmed(digits);
  return value;
}

/// Takes SOURCE off the front of `text`: up to the closing quote, else up to the first '*' or '+'.
std::optional<std::string> take_source(std::string_view& text) {
  if (text.empty() || text[0] != '"') {
    const std::size_t end = std::min(text.find_first_of("*+"), text.size());
    std::string source(trimmed(text.substr(0, end)));
    text.remove_prefix(end);
    return source;
  }
  std::string source;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == '"') {
      const bool doubled = i + 1 < text.size() && text[i + 1] == '"';
      if (!doubled) {
        text = trimmed(text.substr(i + 1));
        return source;
      }
      ++i;
    }
    source += text[i];
  }
  return std::nullopt;
}

/// Takes `[*SCALE][+OFFSET]`, all that is left of `rest`; says what is wrong with it.
std::optional<std::string> take_scale_and_offset(std::string_view rest, ColumnMapping& mapping) {
  if (!rest.empty() && rest[0] == '*') {
    rest.remove_prefix(1);
    const auto scale = take_number(rest);
    if (!scale) return "the scale is no finite number";
    if (*scale == 0.0) return "a scale of 0 would make all values the same";
    mapping.scale = *scale;
  }
  if (!rest.empty() && (rest[0] == '+' || rest[0] == '-')) {
    if (rest[0] == '+') rest.remove_prefix(1);
    const auto offset = take_number(rest);
    if (!offset) return "the offset is no finite number";
    mapping.offset = *offset;
  }
  if (!rest.empty())
    return fmt::format("\"{}\" is left over; quote a SOURCE with * or +", shortened(rest, 100));
  return std::nullopt;
}

}  // namespace

Result<ColumnMapping> parse_column_mapping(std::string_view text) {
  const auto wrong = [&](std::string_view why) {
    return input_error(
        "", fmt::format("column mapping \"{}\": {}; {}", shortened(text, 100), why, kForm));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return wrong("there is no '='");
  ColumnMapping mapping;
  mapping.name = trimmed(text.substr(0, equals));
  if (mapping.name.empty()) return wrong("the NAME is empty");
  std::string_view rest = trimmed(text.substr(equals + 1));
  auto source = take_source(rest);
  if (!source) return wrong("the quote is not closed");
  if (source->empty()) return wrong("the SOURCE is empty");
  mapping.source = std::move(*source);
  if (const auto fault = take_scale_and_offset(rest, mapping)) return wrong(*fault);
  return mapping;
}

}  // namespace awmr
