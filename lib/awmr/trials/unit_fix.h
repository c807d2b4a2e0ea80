/// Mappings that correct a column in a wrong unit. Private to this folder.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/column_mapping.h"

namespace awmr {

/// Likely content of a column, and its conversion to the expected unit: value times `factor`, plus
/// `offset`.
struct UnitFix {
  std::string words;        ///< "8-bit PWM counts"
  std::string_view column;  ///< "wheel_force"
  double factor = 1.0;
  double offset = 0.0;
};

/// "map it by --column 'A'"; if there are several, or other units without a known mapping
/// (`in_doubt`), "(percent) or by --column 'B' (PWM counts)". Empty without any. `mappings` are
/// those with which the table was read.
std::string mapped_by(std::span<const UnitFix> unit_fixes, std::span<const ColumnMapping> mappings,
                      bool in_doubt = false);

/// "percent", "percent or 8-bit PWM counts", "percent, volts or newtons".
std::string words_of(std::span<const UnitFix> unit_fixes);

}  // namespace awmr
