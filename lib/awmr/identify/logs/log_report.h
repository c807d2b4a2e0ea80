/// The entry of a fit of logs among the estimates. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/ceres_problem.h"
#include "awmr/identify/logs/identifiability.h"
#include "awmr/model/record.h"

namespace awmr {

/// Input of the report.
struct LogReportInput {
  const LogProblem& problem;
  const Solved& solved;
  const Identifiability& found;
  const std::vector<Interval>& bootstrap95;  ///< of the value, by quantity; empty: not requested
};

/// Values of all quantities, errors of those that the logs show, and tests whether the standardised
/// residuals of each channel are white and normal. The multistart is not in it.
EstimatorReport log_report(const LogReportInput& input);

/// Leaves the values without standard errors and intervals.
void withdraw_intervals(EstimatorReport& report);

}  // namespace awmr
