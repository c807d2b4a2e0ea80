#include "awmr/identify/uncertainty/quantiles.h"

#include <boost/math/distributions/students_t.hpp>

namespace awmr {

double t_quantile_95(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975);
}

}  // namespace awmr
