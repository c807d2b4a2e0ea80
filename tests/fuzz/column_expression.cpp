/// A column formula or mapping is compiled and gives a number, or is refused.
#include "awmr/core/column_expression.h"

#include <cmath>

#include "awmr/core/column_mapping.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = awmr::fuzz::text_of(data, size);
  auto expression = awmr::ColumnExpression::parse(text);
  if (expression) {
    require(text.size() <= awmr::ColumnExpression::kLongest, "a formula is short");
    const std::vector<double> values(expression->names().size(), 0.5);
    const double once = (*expression)(values);
    const double again = (*expression)(values);
    require(once == again || (std::isnan(once) && std::isnan(again)), "a formula has no memory");
  } else {
    require(!expression.error().empty() && expression.error().size() < 5'000,
            "an error can be read");
  }
  const auto mapping = awmr::parse_column(text);
  if (!mapping) {
    require(awmr::to_text(mapping.error()).size() < 5'000, "an error can be read");
    return 0;
  }
  require(!mapping->name.empty() && !mapping->expression.empty(), "a mapping has two sides");
  require(mapping->scale != 0.0 && std::isfinite(mapping->offset), "a scale can be undone");
  return 0;
}
