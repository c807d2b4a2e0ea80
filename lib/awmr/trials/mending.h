/// What would mend a column that is in another unit. Private to this folder.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/column_mapping.h"

namespace awmr {

/// What a column most likely holds, and what makes it what it is taken for: its values times `factor`,
/// plus `offset`.
struct Mending {
  std::string words;        ///< "8-bit PWM counts"
  std::string_view column;  ///< "wheel_force"
  double factor = 1.0;
  double offset = 0.0;
};

/// "map it by --column 'A'", and where there are several, or others that no mapping is known for
/// (`in_doubt`), "(percent) or by --column 'B' (PWM counts)". Empty where there is none. `mappings` are those
/// that the table was read with.
std::string mapped_by(std::span<const Mending> mendings, std::span<const ColumnMapping> mappings,
                      bool in_doubt = false);

/// "percent", "percent or 8-bit PWM counts", "percent, volts or newtons".
std::string words_of(std::span<const Mending> mendings);

}  // namespace awmr
