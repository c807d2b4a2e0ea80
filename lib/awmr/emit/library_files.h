/// The files of the emitted library that do not depend on the model, as they were built in.
/// Private to emit/.
#pragma once

#include <string_view>
#include <vector>

namespace awmr {

struct EmbeddedFile {
  std::string_view path;
  std::string_view bytes;
};

/// In the order of their paths within each part.
const std::vector<EmbeddedFile>& embedded_files();

}  // namespace awmr
