/// Fuzz target: compiles the bytes as a column formula and as a column mapping. Each gives a number
/// or a readable error.
#include "awmr/core/csv/column_expression.h"

#include <cmath>

#include "awmr/core/column_mapping.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = awmr::fuzz::text_of(data, size);
  auto expression = awmr::ColumnExpression::parse(text);
  if (expression) {
    require(text.size() <= awmr::ColumnExpression::kLongest, "a compiled formula is not too long");
    const std::vector<double> values(expression->names().size(), 0.5);
    const double once = (*expression)(values);
    const double again = (*expression)(values);
    require(once == again || (std::isnan(once) && std::isnan(again)),
            "a formula gives the same value again");
  } else {
    require(!expression.error().empty() && expression.error().size() < 5'000,
            "the error text is short");
  }
  const auto mapping = awmr::parse_column(text);
  if (!mapping) {
    require(awmr::to_text(mapping.error()).size() < 5'000, "the error text is short");
    return 0;
  }
  require(!mapping->name.empty() && !mapping->expression.empty(),
          "a mapping has a name and an expression");
  require(mapping->scale != 0.0 && std::isfinite(mapping->offset),
          "the scale is not 0, the offset finite");
  return 0;
}
