/// A file that lib/cmake/Embed.cmake compiled into the program.
#pragma once

#include <string_view>

namespace awmr {

struct EmbeddedFile {
  std::string_view path;  ///< relative path with '/' as separator
  std::string_view bytes;
};

}  // namespace awmr
