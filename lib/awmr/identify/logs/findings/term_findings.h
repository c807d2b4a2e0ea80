/// Findings about terms of a fit that the model does not contain: delays, filters and constant
/// errors of commands and sensors (command_findings.cpp), forces (force_findings.cpp), and
/// differences between logs (log_findings.cpp). Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// Value of an identified quantity, and its standard error.
struct Identified {
  double value = 0.0;
  double error = 0.0;
};

/// The quantity `what` (place_of()), if the fit contains and identifies it.
template <class What>
std::optional<Identified> identified(const LogFit& fit, What what) {
  const auto i = place_of(fit.quantities, what);
  if (!i || !fit.refusal_reason[*i].empty()) return std::nullopt;
  const FreeQuantity& q = fit.quantities[*i];
  const double x = fit.coordinates[*i];
  return Identified{q.value(x), q.jacobian(x) * fit.error_of(*i)};
}

/// True if the value exceeds two standard errors. If it does not, it can be due to noise.
bool is_significant(const Identified& quantity);

/// The quantity `what` (place_of()), if the fit identifies it and it is significant.
template <class What>
std::optional<Identified> significant(const LogFit& fit, What what) {
  const auto found = identified(fit, what);
  return found && is_significant(*found) ? found : std::nullopt;
}

/// A smaller effect is not reported, because no correction of the vehicle is as exact: a difference
/// of forces or resistances (a share), an exponent of the forces minus 1, a slip ratio, an offset
/// of the centre of gravity (m).
inline constexpr double kMinReported = 0.005;

/// Length of a vector with these components. The components are assumed to be uncorrelated.
Identified length_of(const Identified& x, const Identified& y);

/// Returns one finding for each force of extra_forces.h that differs from 0 by more than two
/// standard errors.
std::vector<Finding> force_findings(const LogFit& fit, const std::string& file);

/// Returns findings about the bias of the gyroscope, and about differences between the logs
/// (log_terms.h). `logs`: the fitted logs.
std::vector<Finding> log_findings(const LogFit& fit, const std::vector<DrivingLog>& logs);

/// Returns one finding for each significant term that the fit identifies
/// (LogFit::is_significant()). A term is a delay, a lag, an error of commands or sensors, or a
/// force of extra_forces.h (force_findings()). `withdrawn`: true if the fit has no valid intervals;
/// the messages then say so. `logs`: the fitted logs; most findings name the file of the first.
std::vector<Finding> command_and_sensor_findings(const LogFit& fit, bool withdrawn,
                                                 const std::vector<DrivingLog>& logs);

/// True if the fit has both a dead zone of the motors and a force that decays with their lag after a
/// command of 0. The controller may apply the dead zone before the lag, the model applies it behind
/// the lag, and the values differ by more than their intervals.
bool has_dead_zone_of_unknown_place(const LogFit& fit);

/// True if the fit has found a large saturation of the forces: the largest command loses more than
/// 5 % of its force, or the exponent of the forces is below 0.95. The intervals of such a fit are
/// too narrow, because the true form of the saturation is unknown. A wrong form makes the force of
/// small commands wrong, and with it all other values.
bool saturates_much(const LogFit& fit);

/// True if a term of the fit is so large that another error probably acts like it. The intervals
/// are then not valid. Such terms are:
///   - left and right forces that differ from their mean by more than 25 %, which is more than real
///     motors do. For example, the speed column may be the speed of one wheel, u - d r or u + d r
///     (d: half of the track width, r: yaw rate);
///   - a slip ratio above a quarter at the largest force of the wheels that measure the speed or
///     the yaw rate, if no position confirms it. A sensor that reacts late at low speed has the
///     same effect as slip.
bool has_implausible_term(const LogFit& fit);

/// Withdraws the intervals of a resistance whose Stribeck friction is above 5 % of its Coulomb
/// friction. All terms of this resistance depend on how the friction decreases with speed, and the
/// logs do not show the true form of this decrease. (m' and I'z depend on it much less.)
void withdraw_by_stribeck(LogFit& fit);

}  // namespace awmr
