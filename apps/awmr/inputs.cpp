#include "inputs.h"

#include "awmr/core/input_file.h"

namespace awmr::cli {

InputNames names_in_project(const std::vector<std::filesystem::path>& paths,
                            const std::filesystem::path& project) {
  InputNames names;
  for (const std::filesystem::path& path : paths) {
    // Empty where one of the two is absolute and the other is not.
    const auto relative =
        path.lexically_normal().lexically_relative(project.parent_path().lexically_normal());
    if (!relative.empty()) names[path] = relative.generic_string();
  }
  return names;
}

Result<std::vector<InputFile>> input_files(const std::vector<std::filesystem::path>& paths,
                                           const InputNames& names) {
  std::vector<InputFile> files;
  for (const std::filesystem::path& path : paths) {
    AWMR_ASSIGN_OR_RETURN(InputFile file, input_file(path));
    if (const auto name = names.find(path); name != names.end()) file.name = name->second;
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
