/// The macros of awmr_params.h, before they are text. Private to emit/.
#pragma once

#include <string>
#include <vector>

#include "awmr/emit/emit.h"

namespace awmr {

enum class MacroRange { kPositive, kNotNegative, kAnySign };

struct Macro {
  std::string name;
  double value = 0.0;
  std::string comment;  ///< symbol, unit, meaning, origin
  std::string place;    ///< `FILE:/json/pointer` of the value
  MacroRange range = MacroRange::kPositive;
};

/// In the order of the header. Precondition: the model has a value for each.
std::vector<Macro> macros_of(const Model& model, const Gains<double>& gains,
                             const EmitInputs& inputs);

/// Errors (input): not a normal float32 (0 is one where the range allows it), or out of range.
Status check_macros(const std::vector<Macro>& macros);

}  // namespace awmr
