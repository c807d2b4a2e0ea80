/// Files compiled into the program as text by lib/cmake/Embed.cmake.
#pragma once

#include <string_view>

namespace awmr {

struct EmbeddedFile {
  std::string_view path;  ///< relative, with '/'
  std::string_view bytes;
};

}  // namespace awmr
