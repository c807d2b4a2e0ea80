#include "awmr/trials/log_files.h"

#include <algorithm>
#include <system_error>

namespace awmr {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> with_extension(const fs::path& directory, const std::string& extension,
                                     std::error_code& error) {
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
    if (entry.path().extension() == extension) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

Result<std::vector<fs::path>> files_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return std::vector<fs::path>{path};
  for (const char* extension : {".db3", ".csv"}) {
    std::vector<fs::path> paths = with_extension(path, extension, error);
    if (error) return input_error(path.string(), error.message());
    if (!paths.empty()) return paths;
  }
  return input_error(path.string(),
                     "a log in a directory is a bag (.db3) or tables (.csv) with a topic each; "
                     "there is neither");
}

}  // namespace awmr
