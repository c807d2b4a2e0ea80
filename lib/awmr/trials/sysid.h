/// Reads the JSON that WPILib's SysId records in a robot's characterization tests. Private to this
/// folder.
///
///     {"sysid": true, "test": "Drivetrain", "units": "Meters", "unitsPerRotation": 0.4788,
///      "slow-forward": [[t, left V, right V, left rot, right rot, left rot/s, right rot/s,
///                        rad, rad/s], ...],
///      "slow-backward": ..., "fast-forward": ..., "fast-backward": ...}
///
/// Each test ("slow-forward", ...) becomes a run. "rot" are positions of the wheels in rotations,
/// "rot/s" their velocities; both are converted to metres with unitsPerRotation and units. "rad" is
/// the heading, "rad/s" the yaw rate, "V" the voltage of the motors.
///                      [wpilibsuite/sysid, docs/data-collection.md and AnalysisManager.cpp]
/// The count of numbers in the first row determines their meaning:
///     9   Drivetrain, Drivetrain (Angular)    as above
///     4   Simple, General Mechanism           t, V, rotations, rotations/s
///     10  frc-characterization (older tool)   t, battery V, autospeed, left V, right V, left and
///                                             right rotations, left and right rotations/s, rad
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/csv.h"
#include "awmr/core/result.h"

namespace awmr {

/// The rows of all tests, one test after the other. Each test is a run whose `t_s` begins at 0.
struct SysIdLog {
  std::vector<std::string> header = {};           ///< column names: run, t_s, left_volts, ...
  std::vector<std::vector<double>> columns = {};  ///< by column, then by row
  std::vector<CsvNote> notes = {};                ///< a single note, `sysid-log`

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// True if the text begins with a JSON object that has the key "sysid" or the name of a test in its
/// first 4 KiB.
bool is_sysid(std::string_view bytes);

/// Reads all tests. Some programs record voltages without sign. If the wheels of a side turned
/// backward in a test although none of its voltages is negative, the function makes these voltages
/// negative. Errors: JSON that is not a SysId record; a mechanism that does not drive the robot
/// (elevator, arm); units that are not lengths; no rows; rows with a wrong number of values; times
/// that do not rise.
Result<SysIdLog> read_sysid(std::string_view bytes, const std::string& file);

}  // namespace awmr
