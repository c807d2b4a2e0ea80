#include "awmr/core/input_file.h"

#include <map>
#include <mutex>
#include <utility>

#include "awmr/core/files/hash.h"

namespace awmr {
namespace {

/// Hash of the bytes last read from each input file, by the path that the user gave.
struct InputHashes {
  std::mutex mutex;
  std::map<std::string, std::string> by_path;
};

/// A local static, because static initialisers of other files may already read input files.
InputHashes& input_hashes() {
  static InputHashes all;
  return all;
}

}  // namespace

Result<std::string> read_input(const std::filesystem::path& path, std::size_t max_bytes) {
  AWMR_ASSIGN_OR_RETURN(std::string bytes, read_file(path, max_bytes));
  std::string hash = sha256_hex(bytes);
  const std::scoped_lock lock(input_hashes().mutex);
  input_hashes().by_path[path.string()] = std::move(hash);
  return bytes;
}

Result<InputFile> input_file(const std::filesystem::path& path) {
  {
    const std::scoped_lock lock(input_hashes().mutex);
    const auto found = input_hashes().by_path.find(path.string());
    if (found != input_hashes().by_path.end()) {
      return InputFile{path.filename().string(), found->second};
    }
  }
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
  return InputFile{path.filename().string(), sha256_hex(bytes)};
}

}  // namespace awmr
