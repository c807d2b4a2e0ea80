#include "unit_fix.h"

#include <fmt/format.h>

#include "awmr/trials/checks/log_evidence.h"

namespace awmr {

std::string mapped_by(std::span<const UnitFix> unit_fixes, std::span<const ColumnMapping> mappings,
                      bool in_doubt) {
  std::string text;
  for (const UnitFix& unit_fix : unit_fixes) {
    text +=
        fmt::format("{}with {}", text.empty() ? "map it " : " or ",
                    mapping_option(mappings, unit_fix.column, unit_fix.factor, unit_fix.offset));
    if (in_doubt || unit_fixes.size() > 1) text += fmt::format(" ({})", unit_fix.words);
  }
  return text;
}

}  // namespace awmr
