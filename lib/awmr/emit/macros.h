/// The macros of awmr_params.h, before they are text. Private to emit/.
#pragma once

#include <string>
#include <vector>

#include "awmr/emit/emit.h"

namespace awmr {

/// The values that a macro may have.
enum class MacroRange { kPositive, kNotNegative, kAnySign };

/// One macro of awmr_params.h.
struct Macro {
  std::string name;     ///< "AWMR_SURGE_ALPHA"
  double value = 0.0;   ///< in the unit that the comment names, before it is rounded to float32
  std::string comment;  ///< symbol, unit, meaning, origin
  std::string place;    ///< `FILE:/json/pointer` of the value
  MacroRange range = MacroRange::kPositive;
};

/// The name of the model's file without its folders, as the emitted files and errors about them
/// call it.
std::string file_name(const Model& model);

/// The macros in the order of the header. Precondition: the model has a value for each.
std::vector<Macro> macros_of(const Model& model, const Gains<double>& gains,
                             const EmitInputs& inputs);

/// Errors (input): not a normal float32 (0 is one where the range allows it), or out of range.
Status check_macros(const std::vector<Macro>& macros);

}  // namespace awmr
