#include "awmr/trials/log_files.h"

#include <utility>

#include "awmr/core/file.h"
#include "awmr/core/input_file.h"

namespace awmr {
namespace {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> with_extension(const std::vector<fs::path>& entries,
                                             const std::string& extension) {
  std::vector<fs::path> paths;
  for (const fs::path& entry : entries) {
    if (entry.extension() != extension) continue;
    AWMR_RETURN_IF_ERROR(check_regular_file(entry));
    paths.push_back(entry);
  }
  return paths;
}

}  // namespace

Result<std::vector<fs::path>> files_of(const fs::path& path) {
  AWMR_ASSIGN_OR_RETURN(const bool is_a_directory, directory_exists(path));
  if (!is_a_directory) return std::vector<fs::path>{path};
  AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> entries, list_directory(path));
  for (const char* extension : {".db3", ".csv"}) {
    AWMR_ASSIGN_OR_RETURN(std::vector<fs::path> paths, with_extension(entries, extension));
    if (!paths.empty()) return paths;
  }
  return input_error(ErrorCode::kMissing, path.string(),
                     "this directory has neither a bag (.db3) nor tables (.csv, one topic each); "
                     "give a directory with one of them, or a file");
}

Result<std::vector<InputFile>> input_files(const std::vector<fs::path>& paths,
                                           const InputNames& names) {
  std::vector<InputFile> files;
  for (const fs::path& path : paths) {
    AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> parts, files_of(path));
    for (const fs::path& part : parts) {
      AWMR_ASSIGN_OR_RETURN(InputFile file, input_file(part));
      if (const auto name = names.find(part); name != names.end()) file.name = name->second;
      files.push_back(std::move(file));
    }
  }
  return files;
}

}  // namespace awmr
