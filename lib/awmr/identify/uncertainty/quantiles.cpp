#include "awmr/identify/uncertainty/quantiles.h"

#include <limits>

#include "awmr/core/distributions.h"

namespace awmr {

double t_quantile_95(double degrees_of_freedom) {
  if (!(degrees_of_freedom > 0.0)) return std::numeric_limits<double>::infinity();
  return students_t_quantile(0.975, degrees_of_freedom);
}

double chi_squared_quantile_95(double degrees_of_freedom) {
  return chi_squared_quantile(0.95, degrees_of_freedom);
}

}  // namespace awmr
