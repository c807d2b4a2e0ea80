/// Texts of faults in JSON values. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/json.h"

namespace awmr {

/// Type and value as text: "number 3"; values longer than 40 bytes are shortened.
std::string describe(const Json& value);
/// Code for a value that is not the expected number: kOutOfRange for a number, else kWrongType.
ErrorCode number_error(const Json& value);
/// Adds a fault at the JSON pointer `pointer` of the file, unless there are kMaxFaults already.
void add_fault(ErrorCode code, std::vector<Fault>& faults, const std::string& file,
               const std::string& pointer, std::string message);

}  // namespace awmr
