/// Checks a driving log for wrong units, signs and sides before anything is fitted, by comparing
/// the channels with each other, the commands and the vehicle.
///
/// Robust ratios over windows of a second need no model of the vehicle:
///
///     change of heading      with   integral of the yaw rate
///     distance of positions  with   integral of the speed
///     course of positions    with   heading, or the integral of the yaw rate
///     yaw rate               with   tau_steering and tau_diff of the commands (allocation.h)
///     sign of the speed      with   rearward thrust that accelerates the vehicle
///     change of a reading    with   usual change between two readings: two runs in one file
///     curvature r/u          with   tan(d_r)/l_f: a vehicle cannot turn far more sharply than its
///                                   front axle points
///
/// A vehicle that never moves is refused first. A ratio near 57.3, 3.6, 1000 or -1 identifies the
/// wrong unit or sign. If any of several columns can be wrong, all are named.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// A column whose values contradict its name, and the mapping that would correct it.
struct Contradiction {
  std::string column;       ///< "yaw_rate_radps"
  std::string message;      ///< the comparison, its result, the likely cause
  std::string mapping;      ///< `NAME=SOURCE*FACTOR`, a column mapping, or none
  std::string remedy = {};  ///< what to do if the mapping alone does not suffice; else empty
};

/// Empty if all channels agree. `mappings`: those with which the log was read, so that the remedy
/// refers to the file's own column. Comparisons with a weak signal (a straight drive, a vehicle at
/// rest, fewer than 10 windows) are skipped.
std::vector<Contradiction> contradictions(const DrivingLog& log, const Vehicle& vehicle,
                                          std::span<const ColumnMapping> mappings);

/// Refuses such a log. Errors (input): each contradiction at `place`, the log as its user named it,
/// with the mapping that corrects it. With `options.as_is` they are findings (`log-contradiction`,
/// a warning) instead. A gyro bias of five standard errors and more is a finding (`gyro-bias`), and
/// so are those of calibration_checks.h.
Status check_consistency(const DrivingLog& log, const std::string& place, const Vehicle& vehicle,
                         const TrialOptions& options, std::vector<Finding>& findings);

/// Constant offset of the yaw rate from the heading's rate, if both were measured and agree.
struct GyroBias {
  double bias_radps = 0.0;
  double std_error_radps = 0.0;
  /// True for a bias of at least five standard errors.
  bool significant() const;
};
std::optional<GyroBias> gyro_bias(const DrivingLog& log);
/// True if the log shows a significant bias.
bool has_gyro_bias(const DrivingLog& log);

}  // namespace awmr
