#include "awmr/core/provenance.h"

#include "awmr/core/hash.h"
#include "awmr/core/version_number.h"

namespace awmr {

const char* version() { return AWMR_VERSION; }

Result<InputFile> input_file(const std::filesystem::path& path) {
  auto hash = sha256_of_file(path);
  if (!hash) return tl::unexpected(hash.error());
  return InputFile{path.filename().string(), std::move(*hash)};
}

}  // namespace awmr
