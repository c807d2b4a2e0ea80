#include "awmr/core/input_file.h"

#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "awmr/core/hash.h"

namespace awmr {
namespace {

/// Hash of the bytes last read from each input file, by the path that the user gave.
class InputHashes {
 public:
  void put(const std::string& path, std::string sha256) {
    const std::scoped_lock lock(mutex_);
    hashes_[path] = std::move(sha256);
  }
  std::optional<std::string> find(const std::string& path) {
    const std::scoped_lock lock(mutex_);
    const auto found = hashes_.find(path);
    return found == hashes_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> hashes_;
};

/// A local static, because static initialisers of other files may already read input files.
InputHashes& input_hashes() {
  static InputHashes all;
  return all;
}

}  // namespace

Result<std::string> read_input(const std::filesystem::path& path, std::size_t max_bytes) {
  AWMR_ASSIGN_OR_RETURN(std::string bytes, read_file(path, max_bytes));
  input_hashes().put(path.string(), sha256_hex(bytes));
  return bytes;
}

Result<InputFile> input_file(const std::filesystem::path& path) {
  if (auto hash = input_hashes().find(path.string())) {
    return InputFile{path.filename().string(), std::move(*hash)};
  }
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(path));
  return InputFile{path.filename().string(), sha256_hex(bytes)};
}

}  // namespace awmr
