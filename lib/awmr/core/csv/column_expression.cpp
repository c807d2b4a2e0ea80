#include "awmr/core/csv/column_expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/csv.h"
#include "awmr/core/text.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

constexpr std::array<std::string_view, 15> kFunctions{"sin",  "cos",   "tan",  "asin",  "acos",
                                                      "atan", "atan2", "sqrt", "abs",   "min",
                                                      "max",  "exp",   "ln",   "log10", "sign"};

/// True if a column name without quotes can begin with this byte. Bytes above 0x7F belong to UTF-8
/// characters, which names may contain.
bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80U;
}

bool continues_name(char c) { return begins_name(c) || is_digit(c) || c == '.'; }

/// A formula rewritten for the library muParser. Columns are renamed to c0, c1, ..., because
/// muParser does not permit every column name.
struct Formula {
  std::vector<std::string> names = {};  ///< columns of the formula, in order of first use
  std::string text = {};                ///< the rewritten formula
  /// One entry for each bracket that is not closed yet: true if it encloses a function's arguments.
  std::vector<bool> open = {};
};

std::string_view without_spaces(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
}

void add_column(std::string_view name, Formula& formula) {
  auto found = std::find(formula.names.begin(), formula.names.end(), name);
  if (found == formula.names.end()) {
    formula.names.emplace_back(name);
    found = formula.names.end() - 1;
  }
  formula.text += fmt::format(" c{} ", found - formula.names.begin());
}

/// Removes a column name such as `name`, `name.of.parts` or `name[0]` from the front of `rest` and
/// returns it.
std::string_view take_bare_name(std::string_view& rest) {
  std::size_t end = 0;
  while (end < rest.size() && continues_name(rest[end])) {
    ++end;
    if (end == rest.size() || rest[end] != '[') continue;
    std::size_t close = end + 1;
    while (close < rest.size() && is_digit(rest[close])) ++close;
    if (close == end + 1 || close == rest.size() || rest[close] != ']') continue;
    end = close + 1;
  }
  const std::string_view name = rest.substr(0, end);
  rest.remove_prefix(end);
  return name;
}

/// Each function below removes one token from the front of `rest`, the part of the formula that is
/// not parsed yet, and adds it to `formula`. It returns the text of an error, or nothing.
using Wrong = std::optional<std::string>;

Wrong take_number(std::string_view& rest, Formula& formula) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc() || !std::isfinite(value)) {
    return fmt::format("\"{}\" is not a finite number", shortened(rest, 40));
  }
  formula.text += fmt::format(" {} ", format_number(value));
  rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
  return std::nullopt;
}

Wrong take_quoted_name(std::string_view& rest, Formula& formula) {
  const std::size_t close = rest.find(rest[0], 1);
  if (close == std::string_view::npos) return fmt::format("the quote {} is not closed", rest[0]);
  if (close == 1) return "a column's name is empty";
  add_column(rest.substr(1, close - 1), formula);
  rest.remove_prefix(close + 1);
  return std::nullopt;
}

Wrong take_name(std::string_view& rest, Formula& formula) {
  const std::string_view name = take_bare_name(rest);
  rest = without_spaces(rest);
  if (rest.starts_with('(')) {
    if (!contains(kFunctions, name)) {
      return fmt::format("there is no function {}; use one of {}", shortened(name, 40),
                         fmt::join(kFunctions, " "));
    }
    rest.remove_prefix(1);
    formula.open.push_back(true);
    formula.text += fmt::format(" {}(", name);
  } else if (name == "pi") {
    formula.text += fmt::format(" {} ", format_number(pi<double>()));
  } else {
    add_column(name, formula);
  }
  return std::nullopt;
}

Wrong take_sign(std::string_view& rest, Formula& formula) {
  const char sign = rest[0];
  if (std::string_view("+-*/^(),").find(sign) == std::string_view::npos) {
    return fmt::format(
        "the character {} is not allowed in a formula; put a column name that contains it in "
        "backticks",
        printable(rest.substr(0, 1)));
  }
  if (sign == '(') formula.open.push_back(false);
  if (sign == ')') {
    if (formula.open.empty()) return "a closing bracket has no opening bracket";
    formula.open.pop_back();
  }
  if (sign == ',' && (formula.open.empty() || !formula.open.back())) {
    return "a comma may only separate the arguments of a function; write decimal numbers with a "
           "point";
  }
  formula.text += sign;
  rest.remove_prefix(1);
  return std::nullopt;
}

tl::expected<Formula, std::string> formula_of(std::string_view text) {
  Formula formula;
  for (std::string_view rest = without_spaces(text); !rest.empty(); rest = without_spaces(rest)) {
    const char next = rest[0];
    Wrong fault;
    if (is_digit(next) || next == '.') {
      fault = take_number(rest, formula);
    } else if (next == '`' || next == '"') {
      fault = take_quoted_name(rest, formula);
    } else if (begins_name(next)) {
      fault = take_name(rest, formula);
    } else {
      fault = take_sign(rest, formula);
    }
    if (fault) return tl::unexpected(*std::move(fault));
  }
  if (!formula.open.empty()) return tl::unexpected(std::string("a bracket is not closed"));
  return formula;
}

}  // namespace

struct ColumnExpression::Compiled {
  mu::Parser parser;
  std::vector<double> values;  ///< values bound to c0, c1, ...
};

ColumnExpression::ColumnExpression(std::vector<std::string> names,
                                   std::unique_ptr<Compiled> compiled)
    : names_(std::move(names)), compiled_(std::move(compiled)) {}
ColumnExpression::ColumnExpression(ColumnExpression&&) noexcept = default;
ColumnExpression& ColumnExpression::operator=(ColumnExpression&&) noexcept = default;
ColumnExpression::~ColumnExpression() = default;

tl::expected<ColumnExpression, std::string> ColumnExpression::parse(std::string_view text) {
  if (text.size() > kLongest) {
    return tl::unexpected(
        fmt::format("the formula has {} bytes; the limit is {}", text.size(), kLongest));
  }
  auto formula = formula_of(text);
  if (!formula) return tl::unexpected(formula.error());
  auto compiled = std::make_unique<Compiled>();
  compiled->values.assign(formula->names.size(), 1.0);
  try {
    for (std::size_t i = 0; i < compiled->values.size(); ++i) {
      compiled->parser.DefineVar(fmt::format("c{}", i), &compiled->values[i]);
    }
    compiled->parser.SetExpr(formula->text);
    compiled->parser.Eval();
  } catch (const mu::ParserError&) {
    return tl::unexpected(std::string(
        "this is not a formula: a value, an operator or an argument is missing or superfluous"));
  }
  return ColumnExpression(std::move(formula->names), std::move(compiled));
}

double ColumnExpression::operator()(std::span<const double> values) {
  std::copy(values.begin(), values.end(), compiled_->values.begin());
  return compiled_->parser.Eval();
}

}  // namespace awmr
