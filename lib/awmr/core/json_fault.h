/// Formatting of JSON faults. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/json.h"

namespace awmr {

/// A value as shown in a fault; long values are cut between characters.
std::string describe(const Json& value);
std::string describe(const NumberRule& rule);
bool allows(const NumberRule& rule, double value);
/// Of a value that is not the expected number: its range, or its type.
ErrorCode number_error(const Json& value);
void add_fault(ErrorCode code, std::vector<Fault>& faults, const std::string& file,
               const std::string& pointer, std::string message);

}  // namespace awmr
