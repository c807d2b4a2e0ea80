/// What several commands read: lists of files, column mappings, and the hashes of what an output is
/// made from.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr::cli {

/// What `--column` takes, in words.
inline constexpr const char* kColumnHelp =
    "[FILE:]NAME=EXPRESSION: where a column comes from: another name (speed_mps=V), scaled "
    "(V*0.2778), arithmetic over columns ((left + right)/2*0.1; odd names in backticks) or a "
    "constant (steering_deg=0); may be repeated";

/// What outputs call their inputs, by path.
using InputNames = std::map<std::filesystem::path, std::string>;

/// The paths relative to the project file, as it names them itself.
InputNames names_in_project(const std::vector<std::filesystem::path>& paths,
                            const std::filesystem::path& project);

/// Name and hash of each file, in this order; of a directory those of the log's files in it. A file
/// that is not in `names` is called by its own name, without its directory. Errors: as input_file()
/// and files_of(), for the first that fails.
Result<std::vector<InputFile>> input_files(const std::vector<std::filesystem::path>& paths,
                                           const InputNames& names = {});

inline constexpr const char* kColumnsFileHelp =
    "JSON with an object `columns` of the same (awmr map writes it); --column comes before it";
inline constexpr std::string_view kColumnsSchema = "awmr.columns/1";

/// The JSON Schema of such a file, from what reads it.
std::string columns_schema();

/// Read-back (file.h) of such a file. Errors: as column_mappings().
Status check_columns_text(std::string_view text, const std::string& file);

/// Where mappings come from.
struct ColumnWords {
  std::vector<std::string> columns = {};           ///< as `--column` gave them
  std::optional<std::filesystem::path> file = {};  ///< `--columns-file`
};

/// The mappings of both; of a column that `--column` maps for every file, that of the file is left
/// out. Errors: as parse_column(), for the first that fails; as read_json_file(), unknown keys.
Result<std::vector<ColumnMapping>> column_mappings(const ColumnWords& words);

/// What `read(path)` makes of each file, in this order; the faults of all files come together.
template <class Read>
auto read_each(const std::vector<std::filesystem::path>& paths, const Read& read)
    -> Result<std::vector<typename decltype(read(paths[0]))::value_type>> {
  std::vector<typename decltype(read(paths[0]))::value_type> all;
  std::vector<Fault> faults;
  for (const std::filesystem::path& path : paths) {
    auto one = read(path);
    if (one) {
      all.push_back(std::move(*one));
    } else {
      faults.insert(faults.end(), one.error().faults.begin(), one.error().faults.end());
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return all;
}

}  // namespace awmr::cli
