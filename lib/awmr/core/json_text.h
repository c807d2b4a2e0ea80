/// Escapes keys in JSON pointers.
#pragma once

#include <string>
#include <string_view>

namespace awmr {

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
