#include "inputs.h"

#include <algorithm>

#include "awmr/core/json/json.h"
#include "awmr/core/json/json_document.h"

namespace awmr::cli {

InputNames names_in_project(const std::vector<std::filesystem::path>& paths,
                            const std::filesystem::path& project) {
  InputNames names;
  for (const std::filesystem::path& path : paths) {
    // The relative path is empty if only one of the two paths is absolute. Output files then give
    // the file's name without directory.
    const auto relative =
        path.lexically_normal().lexically_relative(project.parent_path().lexically_normal());
    if (!relative.empty()) names[path] = relative.generic_string();
  }
  return names;
}

namespace {

std::vector<ColumnMapping> columns_from_json(JsonObject& json) {
  json.schema(kColumnsSchema);
  // Ignores the keys that `awmr map` writes only as information for the user.
  for (const char* key : {"guesses", "open", "names", "command", "version", "options", "inputs"}) {
    json.ignore(key);
  }
  std::vector<ColumnMapping> mappings;
  JsonObject columns = json.object("columns");
  for (const std::string& name : columns.keys()) {
    const std::string expression = columns.string(name);
    if (expression.empty()) continue;
    if (auto mapping = parse_column(name, expression)) {
      mappings.push_back(*std::move(mapping));
    } else {
      columns.fault(name, mapping.error());
    }
  }
  json.reject_unknown_keys();
  return mappings;
}

}  // namespace

std::string columns_schema() {
  return json_schema_text(kColumnsSchema, "Column mappings of a log",
                          [](JsonObject& json) { columns_from_json(json); });
}

Status check_columns_text(std::string_view text, const std::string& file) {
  return check_json_object(text, file, columns_from_json);
}

Result<std::vector<ColumnMapping>> column_mappings(const ColumnWords& words) {
  std::vector<ColumnMapping> mappings;
  for (const std::string& text : words.columns) {
    AWMR_ASSIGN_OR_RETURN(ColumnMapping mapping, parse_column(text));
    mappings.push_back(std::move(mapping));
  }
  if (!words.file) return mappings;
  AWMR_ASSIGN_OR_RETURN(std::vector<ColumnMapping> more,
                        read_json_object(*words.file, columns_from_json));
  for (ColumnMapping& mapping : more) {
    const bool given = std::any_of(mappings.begin(), mappings.end(), [&](const auto& other) {
      return other.name == mapping.name && other.file.empty();
    });
    if (!given) mappings.push_back(std::move(mapping));
  }
  return mappings;
}

}  // namespace awmr::cli
