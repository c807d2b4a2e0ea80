#include "unit_fix.h"

#include <fmt/format.h>

#include "awmr/core/option_text.h"
#include "awmr/trials/log_evidence.h"

namespace awmr {

std::string mapped_by(std::span<const UnitFix> unit_fixes, std::span<const ColumnMapping> mappings,
                      bool in_doubt) {
  std::string text;
  for (const UnitFix& unit_fix : unit_fixes) {
    const std::string option = option_text(
        "column '" + scaled_mapping(mappings, unit_fix.column, unit_fix.factor, unit_fix.offset) +
        "'");
    text += fmt::format("{}with {}", text.empty() ? "map it " : " or ", option);
    if (in_doubt || unit_fixes.size() > 1) text += fmt::format(" ({})", unit_fix.words);
  }
  return text;
}

std::string words_of(std::span<const UnitFix> unit_fixes) {
  std::string text;
  for (std::size_t i = 0; i < unit_fixes.size(); ++i) {
    const bool is_last = i + 1 == unit_fixes.size();
    text += fmt::format("{}{}", i == 0 ? "" : is_last ? " or " : ", ", unit_fixes[i].words);
  }
  return text;
}

}  // namespace awmr
