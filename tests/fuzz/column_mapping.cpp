/// Fuzz target: reads the bytes as a column mapping. The reader returns an invertible scale or a
/// readable error.
#include <cmath>

#include "awmr/core/csv.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto mapping = awmr::parse_column(awmr::fuzz::text_of(data, size));
  if (!mapping) {
    require(awmr::to_text(mapping.error()).size() < 5'000, "the error text is short");
    return 0;
  }
  require(!mapping->name.empty() && !mapping->expression.empty(),
          "a mapping has a name and an expression");
  require(std::isfinite(mapping->scale) && mapping->scale != 0.0, "the scale is finite and not 0");
  require(std::isfinite(mapping->offset), "an offset is finite");
  return 0;
}
