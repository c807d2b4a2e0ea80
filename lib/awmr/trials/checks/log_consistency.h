/// Checks a driving log for wrong units and signs and for swapped left and right forces, before any
/// fit. The check compares the channels with each other, with the commands and with the vehicle
/// file.
///
/// From the vehicle file, it compares sample_time_s with the row spacing, wheel_force with the
/// forces, and the steering stop with the steering angles. The other comparisons need no model of
/// the vehicle. They use windows of one second, except that a jump is a change between two
/// successive readings:
///
///     change of heading      with   integral of the yaw rate
///     distance of positions  with   integral of the speed
///     course of positions    with   heading, or the integral of the yaw rate
///     yaw rate               with   tau_steering and tau_diff of the commands (allocation.h)
///     sign of the speed      with   sign of the thrust
///     change of a reading    with   its usual change; a jump means two runs in one file
///     curvature r/u          with   tan(d_r)/l_f, about the largest possible curvature
///
/// A ratio near 57.3, 3.6, 1000 or -1 identifies the wrong unit or sign. If one of several columns
/// must be wrong but the log does not show which one, the message names all of them. A log in which
/// the vehicle never moves is refused.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// A column with a wrong unit or sign.
struct Contradiction {
  std::string column;       ///< wrong column: "yaw_rate_radps"
  std::string message;      ///< text: what was compared, the result, the likely cause
  std::string mapping;      ///< column mapping that corrects it, `NAME=SOURCE*FACTOR`; may be empty
  std::string remedy = {};  ///< advice that the message shows instead of `mapping`; may be empty
};

/// Makes the comparisons above, and returns the columns with a wrong unit or sign. Returns an empty
/// vector if all channels agree. `mappings`: column mappings with which the log was read;
/// Contradiction::mapping names the columns of the file as these mappings do. Skips a comparison if
/// both signals are too small to be compared (a straight drive, a vehicle at rest), or if the log
/// has too few windows of one second.
std::vector<Contradiction> contradictions(const DrivingLog& log, const Vehicle& vehicle,
                                          std::span<const ColumnMapping> mappings);

/// Checks a log by contradictions(). Errors (input): each contradiction, with the mapping that
/// corrects it. If `options.as_is` is true, contradictions are no errors, but warnings
/// (`log-contradiction`). `place` names the log in errors. For a log without contradictions, adds
/// the findings of calibration_checks.h, and `gyro-bias` if gyro_bias_radps() is not empty.
Status check_consistency(const DrivingLog& log, const std::string& place, const Vehicle& vehicle,
                         const TrialOptions& options, std::vector<Finding>& findings);

}  // namespace awmr
