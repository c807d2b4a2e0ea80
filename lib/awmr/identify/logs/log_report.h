/// Report of a log fit for /estimates of model.json. Private to identify/.
#pragma once

#include <string_view>
#include <vector>

#include "awmr/identify/logs/problem/identifiability.h"
#include "awmr/identify/logs/problem/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

struct LogReportInput {
  const LogProblem& problem;
  const Solved& solved;
  const Identifiability& found;
  /// 95 % interval by the bootstrap, one per quantity. Empty if no bootstrap was requested.
  const std::vector<Interval>& bootstrap95;
};

/// Builds the report of a fit: the values of all quantities, the standard errors of those that the
/// logs identify, and tests whether the standardised residuals of each channel are white and
/// normal. It does not include the searches of the multistart.
EstimatorReport log_report(const LogReportInput& input);

/// Removes standard error and interval of a parameter, but not its value.
inline void withdraw(EstimatorParameter& parameter) {
  parameter.std_error.reset();
  parameter.ci95.reset();
}
/// Does so for all parameters whose names begin with `prefix`.
void withdraw_intervals(EstimatorReport& report, std::string_view prefix = "");

/// Withdraws the intervals of the model parameters in `report` that depend on the slip of wheels:
/// of all if the yaw rate has slip (`is_of_yaw`), else of all but those of turning (yaw resistance,
/// I'z, sway, steering). Returns the names of these parameters.
std::vector<std::string> withdraw_of_slip(bool is_of_yaw, EstimatorReport& report);

/// Withdraws the intervals of the model parameters in `report` that differ from those in `other` by
/// more than one standard error. Returns the names of these parameters.
std::vector<std::string> withdraw_different(const EstimatorReport& other, EstimatorReport& report);

}  // namespace awmr
