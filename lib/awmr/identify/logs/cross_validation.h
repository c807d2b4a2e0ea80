/// Prediction of each log by a fit of the others. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

struct CrossValidation {
  std::vector<LeaveOneOut> leave_one_out;  ///< by log
  std::vector<Finding> findings;           ///< `held-out-log`: the errors of the prediction
};

/// Fits without each log in turn and predicts it. Precondition: at least two logs.
CrossValidation leave_one_log_out(const std::vector<DrivingLog>& logs, LogFitOptions options);

}  // namespace awmr
