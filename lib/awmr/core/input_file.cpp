#include "awmr/core/input_file.h"

#include "awmr/core/hash.h"

namespace awmr {

Result<InputFile> input_file(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(std::string hash, sha256_of_file(path));
  return InputFile{path.filename().string(), std::move(hash)};
}

}  // namespace awmr
