#include "awmr/core/column_mapping.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/csv/column_expression.h"
#include "awmr/core/csv/csv_cell.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

constexpr std::string_view kForm =
    "expected NAME=EXPRESSION, for example speed_mps=(left + right)/2*0.1";

/// Removes a finite number from the front of `text` and returns it; empty if there is none.
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

/// Removes the column name from the front of a text `NAME*SCALE+OFFSET` and returns it. A quoted
/// name ends at the closing quote, any other name before the first '*' or '+'. Empty if the quote
/// is not closed.
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

/// The column name in double quotes, as take_source() reads it.
std::string in_quotes(std::string_view source) {
  std::string text = "\"";
  for (const char c : source) text.append(c == '"' ? 2 : 1, c);
  return text + '"';
}

/// Parses `rest` as `[*SCALE][+OFFSET]` and stores both numbers in `mapping`. Returns false if
/// `rest` is not of this form.
bool take_scale_and_offset(std::string_view rest, ColumnMapping& mapping) {
  if (rest.starts_with('*')) {
    rest.remove_prefix(1);
    const auto scale = take_number(rest);
    if (!scale) return false;
    mapping.scale = *scale;
  }
  if (rest.starts_with('+') || rest.starts_with('-')) {
    if (rest[0] == '+') rest.remove_prefix(1);
    const auto offset = take_number(rest);
    if (!offset) return false;
    mapping.offset = *offset;
  }
  return rest.empty();
}

/// Parses `SOURCE[*SCALE][+OFFSET]`. Returns false if `body` is not of this form.
bool take_body(std::string_view body, ColumnMapping& mapping) {
  auto source = take_source(body);
  if (!source || source->empty()) return false;
  mapping.source = std::move(*source);
  return take_scale_and_offset(body, mapping);
}

tl::unexpected<Error> wrong(std::string_view text, std::string_view why) {
  return input_error(
      ErrorCode::kBadFormula, "",
      fmt::format("column mapping \"{}\": {}; {}", shortened(text, 100), why, kForm));
}

}  // namespace

Result<ColumnMapping> parse_column(std::string_view name, std::string_view expression) {
  return parse_column(fmt::format("{}={}", name, expression));
}

Result<ColumnMapping> parse_column(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return wrong(text, "there is no '='");
  const std::string_view target = text.substr(0, equals);
  const std::string_view body = trimmed(text.substr(equals + 1));
  const std::size_t colon = target.rfind(':');
  const bool per_file = colon != std::string_view::npos;
  ColumnMapping mapping{.name = std::string(trimmed(target.substr(per_file ? colon + 1 : 0))),
                        .source = {}};
  if (per_file) mapping.file = trimmed(target.substr(0, colon));
  if (mapping.name.empty()) return wrong(text, "the NAME is empty");
  if (per_file && mapping.file.empty()) return wrong(text, "the FILE is empty");
  if (body.empty()) return wrong(text, "the EXPRESSION is empty");
  mapping.expression = body;
  const bool is_scaled = take_body(body, mapping);
  if (mapping.scale == 0.0) return wrong(text, "a scale of 0 would make all values the same");
  if (is_scaled) return mapping;
  mapping = {
      .name = mapping.name, .source = {}, .expression = mapping.expression, .file = mapping.file};
  if (const auto expression = ColumnExpression::parse(mapping.expression); !expression) {
    return wrong(text, expression.error());
  }
  return mapping;
}

std::string text_of(const ColumnMapping& mapping) {
  const std::string name =
      mapping.file.empty() ? mapping.name : fmt::format("{}:{}", mapping.file, mapping.name);
  // A constant such as 0.5 is written as it was given, without scale. (The parser also stored it as
  // a column name, because a column can have this name.)
  const bool scaled = !mapping.source.empty() && !number_from_text(mapping.expression);
  if (!scaled) return fmt::format("{}={}", name, mapping.expression);
  // The name is quoted only where the parser needs it, so that plain names remain readable.
  const bool is_plain = mapping.source.find_first_of("*+\"") == std::string::npos &&
                        trimmed(mapping.source).size() == mapping.source.size();
  return fmt::format("{}={}*{}+{}", name, is_plain ? mapping.source : in_quotes(mapping.source),
                     format_number(mapping.scale), format_number(mapping.offset));
}

std::string scaled_expression(const ColumnMapping& mapping, double factor, double offset) {
  const bool has_operator = mapping.source.find_first_of("+-*/^(") != std::string::npos;
  const bool is_quoted = mapping.expression.starts_with('"');
  const bool is_formula =
      mapping.source.empty() || (has_operator && !is_quoted && !mapping.expression.empty() &&
                                 ColumnExpression::parse(mapping.expression).has_value());
  const double scale = is_formula ? factor : factor * mapping.scale;
  const std::string source =
      is_formula ? fmt::format("({})", mapping.expression) : in_quotes(mapping.source);
  const std::string scaled = scale == 1.0 ? source : fmt::format("{}*{:.7g}", source, scale);
  // The text of a formula contains its offset. Only a scaled column has a separate one.
  const double added = offset + (is_formula ? 0.0 : factor * mapping.offset);
  return added == 0.0 ? scaled : fmt::format("{}{:+.7g}", scaled, added);
}

}  // namespace awmr
