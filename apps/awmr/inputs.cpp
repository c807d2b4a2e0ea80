#include "inputs.h"

#include "awmr/core/input_file.h"

namespace awmr::cli {

Result<std::vector<InputFile>> input_files(const std::vector<std::filesystem::path>& paths) {
  std::vector<InputFile> files;
  for (const std::filesystem::path& path : paths) {
    AWMR_ASSIGN_OR_RETURN(InputFile file, input_file(path));
    files.push_back(std::move(file));
  }
  return files;
}

Result<std::vector<ColumnMapping>> column_mappings(const std::vector<std::string>& texts) {
  std::vector<ColumnMapping> mappings;
  for (const std::string& text : texts) {
    AWMR_ASSIGN_OR_RETURN(ColumnMapping mapping, parse_column_mapping(text));
    mappings.push_back(std::move(mapping));
  }
  return mappings;
}

}  // namespace awmr::cli
