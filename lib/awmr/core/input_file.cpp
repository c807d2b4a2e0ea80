#include "awmr/core/input_file.h"

#include <map>
#include <mutex>
#include <utility>

#include "awmr/core/hash.h"

namespace awmr {
namespace {

/// Hash of the bytes last read from each input file, by the path that the user gave.
std::mutex hashes_mutex;
std::map<std::string, std::string> hashes;

}  // namespace

Result<std::string> read_input(const std::filesystem::path& path, std::size_t max_bytes) {
  AWMR_ASSIGN_OR_RETURN(std::string bytes, read_file(path, max_bytes));
  std::string hash = sha256_hex(bytes);
  const std::lock_guard lock(hashes_mutex);
  hashes[path.string()] = std::move(hash);
  return bytes;
}

Result<InputFile> input_file(const std::filesystem::path& path) {
  {
    const std::lock_guard lock(hashes_mutex);
    const auto found = hashes.find(path.string());
    if (found != hashes.end()) return InputFile{path.filename().string(), found->second};
  }
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
  return InputFile{path.filename().string(), sha256_hex(bytes)};
}

}  // namespace awmr
