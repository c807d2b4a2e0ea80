/// The macros of awmr_params.h before formatting. Private to emit/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/emit/emit.h"

namespace awmr {

/// Permitted range of a macro's value: above 0, at least 0, or any number.
enum class MacroRange { kPositive, kNotNegative, kAnySign };

struct Macro {
  std::string name;     ///< "AWMR_SURGE_ALPHA"
  double value = 0.0;   ///< value in the unit that `comment` names, not yet rounded to float32
  std::string comment;  ///< symbol, unit, meaning, origin
  std::string place;    ///< `FILE:/json/pointer` of the value, for error messages
  MacroRange range = MacroRange::kPositive;
};

/// Name of the model's file without its directory, for comments of emitted files and for errors.
std::string file_name(const Model& model);

/// End of the names of the macros with the gains of a mode, such as "_STEERING".
std::string mode_suffix(YawMode mode);

/// The macros, in the order of the header. Precondition: the model has a value for each of them.
std::vector<Macro> macros_of(const Model& model, const ModeGains& gains, const EmitInputs& inputs);

/// Checks the values. Errors (input), for each value: it is neither 0 nor a normal float32, or out
/// of its range.
Status check_macros(const std::vector<Macro>& macros);

}  // namespace awmr
