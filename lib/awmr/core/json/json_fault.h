/// Texts and places of faults in JSON values. Private to core/.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/json/json.h"

namespace awmr {

/// Type and value of a JSON value for messages, such as "number 3". Values longer than 40 bytes are
/// shortened.
std::string describe(const Json& value);
/// Error code for a value that is not a number in the permitted range: kOutOfRange if it is a
/// number, else kWrongType.
ErrorCode number_error(const Json& value);
/// Adds a fault at the JSON pointer `pointer` of the file, unless there are kMaxFaults already.
void add_fault(ErrorCode code, std::vector<Fault>& faults, const std::string& file,
               const std::string& pointer, std::string message);

/// A key as written in a JSON pointer: '~' as "~0", '/' as "~1". [RFC 6901, section 3]
inline std::string pointer_token(std::string_view key) {
  std::string text;
  for (const char c : key) {
    if (c == '~') {
      text += "~0";
    } else if (c == '/') {
      text += "~1";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace awmr
