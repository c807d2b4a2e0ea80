#include "awmr/identify/uncertainty/quantiles.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <limits>

namespace awmr {

double t_quantile_95(double degrees_of_freedom) {
  if (!(degrees_of_freedom > 0.0)) return std::numeric_limits<double>::infinity();
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975);
}

double chi_squared_quantile_95(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::chi_squared(degrees_of_freedom), 0.95);
}

}  // namespace awmr
