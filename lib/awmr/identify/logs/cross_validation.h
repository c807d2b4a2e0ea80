/// Leave-one-log-out cross-validation: each log is predicted by a fit of the others. Private to
/// identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

struct CrossValidation {
  std::vector<LeaveOneOut> leave_one_out;  ///< by log: values of the fit without this log
  std::vector<Finding> findings;           ///< `held-out-log` with the prediction errors, by log
};

/// Leaves out each log in turn, fits the others and predicts the omitted log. `options`: those of
/// the fit of all logs. Precondition: two logs or more.
CrossValidation leave_one_log_out(const std::vector<DrivingLog>& logs, LogFitOptions options);

}  // namespace awmr
