#include "awmr/identify/logs/problem/widening.h"

#include <algorithm>
#include <cmath>

#include "awmr/core/index.h"

namespace awmr {
namespace {

/// Multiplies the standard error of quantity `i`, and the distances of the ends of its interval
/// from the estimate (in the coordinate), by `factor`. A withdrawn interval stays withdrawn.
void stretch_interval(std::size_t i, double factor, LogFit& fit) {
  EstimatorParameter& parameter = fit.report.parameters[i];
  if (parameter.std_error) *parameter.std_error *= factor;
  if (!parameter.ci95) return;
  const FreeQuantity& q = fit.quantities[i];
  const double x = fit.coordinates[i];
  for (double* const end : {&parameter.ci95->lo, &parameter.ci95->hi}) {
    const double coordinate = to_coordinate(q.scale, *end);
    *end = q.value(x + factor * (coordinate - x));
  }
}

}  // namespace

double widen_by(const Eigen::VectorXd& change, LogFit& fit) {
  double largest = 1.0;
  for (std::size_t i = 0; i < fit.quantities.size(); ++i) {
    const Eigen::Index row = eigen_index(i);
    const double factor = std::sqrt(1.0 + change(row) * change(row) / fit.covariance(row, row));
    stretch_interval(i, factor, fit);
    largest = std::max(largest, factor);
  }
  fit.covariance += change * change.transpose();
  return largest;
}

}  // namespace awmr
