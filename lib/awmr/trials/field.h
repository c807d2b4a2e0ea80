/// Magnetic-field record of a turning vehicle.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/column_mapping.h"
#include "awmr/core/result.h"

namespace awmr {

/// Values by row, at least 30.
struct FieldRecord {
  std::string file;
  std::vector<double> t_s = {};
  std::vector<double> ahead = {};           ///< in any unit, the same as `left`
  std::vector<double> left = {};            ///< to the left
  std::vector<double> yaw_rate_radps = {};  ///< left positive; empty: not recorded
};

/// Reads the columns t_s, field_ahead, field_left and, optionally, yaw_rate_radps. Errors: as
/// read_csv(); time that does not rise; fewer than 30 rows; a mapping of another column, or an
/// unused mapping.
Result<FieldRecord> read_field(const std::filesystem::path& path,
                               const std::vector<ColumnMapping>& mappings);

}  // namespace awmr
