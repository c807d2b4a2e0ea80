/// A record of the magnetic field while the vehicle turns.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/column_mapping.h"
#include "awmr/core/result.h"

namespace awmr {

/// By row, at least 30.
struct FieldRecord {
  std::string file;
  std::vector<double> t_s = {};
  std::vector<double> ahead = {};           ///< in any unit, the same for both
  std::vector<double> left = {};            ///< to the left
  std::vector<double> yaw_rate_radps = {};  ///< left positive; empty: not recorded
};

/// Columns t_s, field_ahead, field_left and, optional, yaw_rate_radps. Errors: as read_csv(); time
/// that does not rise; fewer than 30 rows; a mapping of another column, or one that is not used.
Result<FieldRecord> read_field(const std::filesystem::path& path,
                               const std::vector<ColumnMapping>& mappings);

}  // namespace awmr
