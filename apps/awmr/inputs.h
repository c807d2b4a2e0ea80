/// What several commands read: lists of files, column mappings, and the hashes of what an output is
/// made from.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr::cli {

/// What outputs call their inputs, by path.
using InputNames = std::map<std::filesystem::path, std::string>;

/// The paths relative to the project file, as it names them itself.
InputNames names_in_project(const std::vector<std::filesystem::path>& paths,
                            const std::filesystem::path& project);

/// Name and hash of each file, in this order. A file that is not in `names` is called by its own
/// name, without its directory. Errors: as input_file(), for the first that fails.
Result<std::vector<InputFile>> input_files(const std::vector<std::filesystem::path>& paths,
                                           const InputNames& names = {});

/// The mappings that `--column` gave. Errors: as parse_column_mapping(), for the first that fails.
Result<std::vector<ColumnMapping>> column_mappings(const std::vector<std::string>& texts);

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
