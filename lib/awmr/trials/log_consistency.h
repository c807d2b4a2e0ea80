/// What contradicts itself in a driving log: units, signs and sides, found by holding the channels
/// against each other, the commands and the vehicle, before anything is fitted.
///
/// Robust ratios over windows of a second need no model of the vehicle:
///
///     change of heading      against   integral of the yaw rate
///     distance of positions  against   integral of the speed
///     course of positions    against   heading
///     yaw rate               against   tau_steering and tau_diff of the commands (allocation.h)
///     sign of the speed      against   thrust to the rear that speeds the vehicle up
///     a reading's change     against   what the vehicle does in the time between two: two runs
///     curvature r/u          against   tan(d_r)/l_f: no vehicle turns far more sharply than its
///                                      front axle points
///
/// A vehicle that never moves is refused first. A ratio near 57.3, 3.6, 1000 or -1 tells which unit or sign is off; where one of several columns
/// may be to blame, all are named.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// A column that cannot be what its name says, and the mapping that would mend it.
struct Contradiction {
  std::string column;   ///< "yaw_rate_radps"
  std::string message;  ///< what was compared, what was found, the likely cause
  std::string
      mapping;  ///< `NAME=SOURCE*FACTOR`, to be given as a column mapping; may be two, or none
  std::string remedy = {};  ///< what to do, where that mapping alone does not say it; else empty
};

/// Empty for a log whose channels agree. `mappings`: those that the log was read with, so that the
/// remedy starts from the file's own column. A comparison whose signal is too weak to tell (a
/// straight drive, a vehicle at rest, fewer than 10 windows) says nothing.
std::vector<Contradiction> contradictions(const DrivingLog& log, const Vehicle& vehicle,
                                          std::span<const ColumnMapping> mappings);

/// Refuses such a log. Errors (input): each contradiction at `place`, the log as its user named it,
/// with the mapping that would mend it. With `options.as_is` they are findings (`log-contradiction`,
/// a warning) instead. A gyro bias of five standard errors and more is a finding (`gyro-bias`), and so are
/// those of calibration_checks.h.
Status check_consistency(const DrivingLog& log, const std::string& place, const Vehicle& vehicle,
                         const TrialOptions& options, std::vector<Finding>& findings);

/// The constant offset of the yaw rate against the heading, where both were measured and agree.
struct GyroBias {
  double bias_radps = 0.0;
  double std_error_radps = 0.0;
  /// It is there, by five standard errors or more.
  bool significant() const;
};
std::optional<GyroBias> gyro_bias(const DrivingLog& log);
/// The log shows a significant one.
bool has_gyro_bias(const DrivingLog& log);

}  // namespace awmr
