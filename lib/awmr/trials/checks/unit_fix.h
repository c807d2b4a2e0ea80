/// Column mappings that correct a wrong unit, and their text for messages. Private to trials/.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/column_mapping.h"

namespace awmr {

/// Likely unit of a column. Value in the expected unit = value in the file times `factor` plus
/// `offset`.
struct UnitFix {
  std::string words;        ///< likely unit: "8-bit PWM counts"
  std::string_view column;  ///< awmr's column: "wheel_force"
  double factor = 1.0;
  double offset = 0.0;
};

/// Advice for messages: "map it with --column 'A'", or for several corrections "map it with
/// --column 'A' (percent) or with --column 'B' (PWM counts)". Empty if `unit_fixes` is empty.
/// `in_doubt`: true if units without a known factor are possible, too; then the unit is named even
/// for a single correction. `mappings`: column mappings used to read the table.
std::string mapped_by(std::span<const UnitFix> unit_fixes, std::span<const ColumnMapping> mappings,
                      bool in_doubt = false);

}  // namespace awmr
