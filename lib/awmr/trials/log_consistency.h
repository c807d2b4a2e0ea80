/// Checks a driving log for wrong units and signs and for swapped left and right forces, before
/// anything is fitted. The channels are compared with each other, with the commands and with the
/// vehicle file.
///
/// Compared with the vehicle file: the row spacing with sample_time_s, the forces with wheel_force,
/// the steering angles with the stop. Compared without a model of the vehicle, over windows of one
/// second (changes of a reading: from reading to reading):
///
///     change of heading      with   integral of the yaw rate
///     distance of positions  with   integral of the speed
///     course of positions    with   heading, or the integral of the yaw rate
///     yaw rate               with   tau_steering and tau_diff of the commands (allocation.h)
///     sign of the speed      with   sign of the thrust
///     change of a reading    with   its usual change: a jump means two runs in one file
///     curvature r/u          with   tan(d_r)/l_f, which it cannot exceed by much
///
/// A ratio near 57.3, 3.6, 1000 or -1 identifies the wrong unit or sign. If one of several columns
/// must be wrong, but it is not known which, all of them are named. A log in which the vehicle
/// never moves is refused.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// A column with a wrong unit or sign.
struct Contradiction {
  std::string column;       ///< "yaw_rate_radps"
  std::string message;      ///< the comparison, its result, the likely cause
  std::string mapping;      ///< column mapping that corrects it, `NAME=SOURCE*FACTOR`; may be empty
  std::string remedy = {};  ///< advice to show in place of `mapping`; may be empty
};

/// Returns the columns with a wrong unit or sign; empty if all channels agree. `mappings`: column
/// mappings with which the log was read, so that a correction names the column of the file. A
/// comparison is skipped if its signals are weak (a straight drive, a vehicle at rest) or if the
/// log has too few windows.
std::vector<Contradiction> contradictions(const DrivingLog& log, const Vehicle& vehicle,
                                          std::span<const ColumnMapping> mappings);

/// Checks a log by contradictions(). Errors (input): each contradiction, with the mapping that
/// corrects it. `place` names the log in errors. With `options.as_is`, contradictions are warnings
/// (`log-contradiction`) instead. For a log without contradictions, adds the findings of
/// calibration_checks.h and `gyro-bias` (a significant gyro_bias()).
Status check_consistency(const DrivingLog& log, const std::string& place, const Vehicle& vehicle,
                         const TrialOptions& options, std::vector<Finding>& findings);

/// Bias of the yaw rate: measured yaw rate minus rate of change of the heading.
struct GyroBias {
  double bias_radps = 0.0;
  double std_error_radps = 0.0;
  /// True if the bias exceeds five standard errors.
  bool significant() const;
};
/// Estimates the bias by the median over windows of one second. Empty if heading or yaw rate was
/// not measured, or with fewer than 10 windows.
std::optional<GyroBias> gyro_bias(const DrivingLog& log);
/// True if gyro_bias() is significant.
bool has_gyro_bias(const DrivingLog& log);

}  // namespace awmr
