/// Files that are built into the program as text: lib/cmake/Embed.cmake makes them.
#pragma once

#include <string_view>

namespace awmr {

struct EmbeddedFile {
  std::string_view path;  ///< relative, with '/'
  std::string_view bytes;
};

}  // namespace awmr
