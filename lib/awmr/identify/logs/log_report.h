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

/// Values of all quantities, standard errors of those that the logs identify, and tests whether the
/// standardised residuals of each channel are white and normal. Excludes the multistart.
EstimatorReport log_report(const LogReportInput& input);

/// Removes the standard errors and intervals; the values stay.
void withdraw_intervals(EstimatorReport& report);

}  // namespace awmr
