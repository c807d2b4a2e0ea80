/// Leave-one-log-out cross-validation: each log is predicted by a fit of the others. Private to
/// identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

struct CrossValidation {
  std::vector<LeaveOneOut> leave_one_out;  ///< one per log: values of the fit to the other logs
  std::vector<Finding> findings;  ///< one `held-out-log` per log, with its prediction errors
};

/// Leaves out each log in turn, fits the others and predicts the omitted log. `options`: those of
/// the fit of all logs. Precondition: two logs or more.
CrossValidation leave_one_log_out(const std::vector<DrivingLog>& logs, LogFitOptions options);

}  // namespace awmr
