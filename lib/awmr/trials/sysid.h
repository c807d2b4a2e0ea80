/// Reads the JSON that WPILib's SysId records in a robot's characterization tests. Private to this folder.
///
///     {"sysid": true, "test": "Drivetrain", "units": "Meters", "unitsPerRotation": 0.4788,
///      "slow-forward": [[t, left V, right V, left rot, right rot, left rot/s, right rot/s, rad, rad/s], ...],
///      "slow-backward": ..., "fast-forward": ..., "fast-backward": ...}
///
/// Each test ("slow-forward", ...) becomes a run. The file has positions and velocities in rotations; they are
/// converted to metres with unitsPerRotation and units.
///                      [wpilibsuite/sysid, docs/data-collection.md and AnalysisManager.cpp]
/// Numbers in a row, by the value of "test":
///     Drivetrain, Drivetrain (Angular)    the nine numbers above
///     Simple, General Mechanism           t, V, rotations, rotations/s
///     frc-characterization (older tool)   t, battery V, autospeed, left V, right V, left and right rotations,
///                                         left and right rotations/s, rad
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/result.h"

namespace awmr {

/// All tests one after the other. `t_s` begins at 0 in each run.
struct SysIdLog {
  std::vector<std::string> header = {};  ///< run, t_s, left_volts, ..., in SI units and degrees
  std::vector<std::vector<double>> columns = {};  ///< by column, then by row
  std::vector<CsvNote> notes = {};                ///< one: `sysid-log`

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// True if the first bytes are those of a SysId record.
bool is_sysid(std::string_view bytes);

/// Errors: JSON that is not a SysId record; a mechanism that does not drive the robot (elevator, arm); units
/// that are not lengths; no rows; rows with a wrong number of values; a time that does not rise.
Result<SysIdLog> read_sysid(std::string_view bytes, const std::string& file);

}  // namespace awmr
