/// Report of a log fit for /estimates of model.json. Private to identify/.
#pragma once

#include <string_view>
#include <vector>

#include "awmr/identify/logs/ceres_problem.h"
#include "awmr/identify/logs/identifiability.h"
#include "awmr/model/record.h"

namespace awmr {

/// Input of log_report().
struct LogReportInput {
  const LogProblem& problem;
  const Solved& solved;
  const Identifiability& found;
  /// 95 % interval by the bootstrap, one per quantity. Empty if no bootstrap was requested.
  const std::vector<Interval>& bootstrap95;
};

/// Builds the report of a fit: the values of all quantities, and the standard errors of those that
/// the logs identify. The report also has tests whether the standardised residuals of each channel
/// are white and normal. The searches of the multistart are not included.
EstimatorReport log_report(const LogReportInput& input);

/// Removes the standard error and the interval of a parameter. Keeps its value.
inline void withdraw(EstimatorParameter& parameter) {
  parameter.std_error.reset();
  parameter.ci95.reset();
}
/// Removes the standard errors and intervals from the report. Keeps the values.
void withdraw_intervals(EstimatorReport& report);
/// Removes standard error and interval of the quantity with this name.
void withdraw_interval(EstimatorReport& report, std::string_view name);

/// Withdraws the intervals of the model parameters in `report` whose values differ from those in
/// `other` by more than one standard error. Returns the names of these parameters.
std::vector<std::string> withdraw_different(const EstimatorReport& other, EstimatorReport& report);

}  // namespace awmr
