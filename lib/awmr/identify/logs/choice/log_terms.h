/// Terms that differ between the logs of one vehicle: the scale of the wheel forces (battery
/// voltage), the scale of the resistance (ground), the delay of the commands (time stamps) and the
/// bias of the gyroscope. Each is relative to the first log, whose forces define F_max. All runs of
/// one file count as one log here. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/identify/logs/problem/log_problem.h"

namespace awmr {

/// The term, acting only in the log with this number (DrivingLog::number).
FreeQuantity in_log(FreeQuantity term, int number);

/// Terms of single logs that the fit does not contain: for each log but the first, the scale of its
/// forces, the scales of its surge and yaw resistance, and the delay of its commands and the bias of
/// its gyroscope beyond those of all logs. Empty for a single log, and for more than 12 logs, which
/// would make the search too long. A fit contains a kind of these terms for all logs but the first,
/// or for none.
std::vector<FreeQuantity> further_log_terms(const LogProblem& problem);

/// The terms that belong into the fit with `term` if it is a term of a single log: the others of
/// its kind, and with a delay or bias also that of all logs. Empty for other terms.
std::vector<FreeQuantity> partners_of(const FreeQuantity& term, const LogProblem& problem);

/// The log without the scale of its forces and the bias of its gyroscope in `fit`: with forces as
/// strong as those of the first log, and with the same bias.
DrivingLog without_log_terms(DrivingLog log, const LogFit& fit);

LogFitOptions without_log_terms(LogFitOptions options);

/// Quantities and coordinates of the fit for without_log_terms(log) alone: without terms of single
/// logs, and with the resistance and the delay of this log.
LogFit of_single_log(LogFit fit, const DrivingLog& log);

/// True for a quantity that differs between the logs by a term of single logs in the fit: a delay or
/// bias, or a parameter of a resistance with a scale for each log.
bool differs_by_log(const LogFit& fit, const FreeQuantity& quantity);

}  // namespace awmr
