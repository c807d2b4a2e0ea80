/// Reads the record of a vehicle's magnetometer while it turns, for compass calibration
/// (`awmr compass`).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/column_mapping.h"
#include "awmr/core/result.h"

namespace awmr {

/// Magnetometer record of at least 30 rows. Each vector has one value per row.
struct FieldRecord {
  std::string file;
  std::vector<double> t_s = {};
  std::vector<double> ahead = {};           ///< forward field component, any unit
  std::vector<double> left = {};            ///< leftward field component, same unit
  std::vector<double> yaw_rate_radps = {};  ///< rad/s, left positive; empty: not recorded
};

/// Reads the columns t_s, field_ahead, field_left and, if present, yaw_rate_radps. `mappings`:
/// column mappings for the file. Errors: those of read_csv(); time that does not rise; fewer than
/// 30 rows; a mapping to a column that is not one of these four; an unused mapping.
Result<FieldRecord> read_field(const std::filesystem::path& path,
                               const std::vector<ColumnMapping>& mappings);

}  // namespace awmr
