/// A column mapping is read with an invertible scale, or refused.
#include <cmath>

#include "awmr/core/csv.h"
#include "fuzz/target.h"

using awmr::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto mapping = awmr::parse_column(awmr::fuzz::text_of(data, size));
  if (!mapping) {
    require(awmr::to_text(mapping.error()).size() < 5'000, "an error can be read");
    return 0;
  }
  require(!mapping->name.empty() && !mapping->expression.empty(), "a mapping has two sides");
  require(std::isfinite(mapping->scale) && mapping->scale != 0.0, "a scale can be undone");
  require(std::isfinite(mapping->offset), "an offset is finite");
  return 0;
}
