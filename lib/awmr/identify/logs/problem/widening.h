/// Widens the covariance and the intervals of a log fit by the effect of a quantity that the fit
/// assumes, but that is uncertain. Private to identify/.
#pragma once

#include <Eigen/Core>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// Adds `change` change^T to the covariance of the coordinates. Stretches each standard error and
/// each interval in proportion to the new standard deviation of its coordinate; an interval that is
/// withdrawn stays withdrawn. `change`: change of each coordinate if the uncertain quantity changes
/// by one standard deviation; 0 for refused quantities. Returns the largest factor by which the
/// standard deviation of a coordinate grew.
double widen_by(const Eigen::VectorXd& change, LogFit& fit);

}  // namespace awmr
