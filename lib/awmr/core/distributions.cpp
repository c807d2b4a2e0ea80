#include "awmr/core/distributions.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace awmr {

namespace math = boost::math;

double normal_cdf(double z) { return math::cdf(math::normal(), z); }

double normal_tail(double z) { return math::cdf(math::complement(math::normal(), z)); }

double students_t_tail(double t, double degrees_of_freedom) {
  return math::cdf(math::complement(math::students_t(degrees_of_freedom), t));
}

double students_t_quantile(double p, double degrees_of_freedom) {
  return math::quantile(math::students_t(degrees_of_freedom), p);
}

double chi_squared_tail(double x, double degrees_of_freedom) {
  return math::cdf(math::complement(math::chi_squared(degrees_of_freedom), x));
}

double chi_squared_quantile(double p, double degrees_of_freedom) {
  return math::quantile(math::chi_squared(degrees_of_freedom), p);
}

double fisher_f_tail(double f, double numerator_dof, double denominator_dof) {
  return math::cdf(math::complement(math::fisher_f(numerator_dof, denominator_dof), f));
}

}  // namespace awmr
