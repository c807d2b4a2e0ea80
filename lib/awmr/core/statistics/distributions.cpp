#include "awmr/core/statistics/distributions.h"

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <limits>

namespace awmr {

namespace math = boost::math;

namespace {

/// Computes in double: long double takes three times as long, and differs between processors.
using InDouble = math::policies::policy<math::policies::promote_double<false>>;
using Normal = math::normal_distribution<double, InDouble>;
using StudentsT = math::students_t_distribution<double, InDouble>;
using ChiSquared = math::chi_squared_distribution<double, InDouble>;
using FisherF = math::fisher_f_distribution<double, InDouble>;
using Beta = math::beta_distribution<double, InDouble>;

}  // namespace

double normal_cdf(double z) { return math::cdf(Normal(), z); }

double normal_tail(double z) { return math::cdf(math::complement(Normal(), z)); }

double students_t_tail(double t, double degrees_of_freedom) {
  return math::cdf(math::complement(StudentsT(degrees_of_freedom), t));
}

double students_t_quantile(double p, double degrees_of_freedom) {
  return math::quantile(StudentsT(degrees_of_freedom), p);
}

double t_quantile_95(double degrees_of_freedom) {
  if (!(degrees_of_freedom > 0.0)) return std::numeric_limits<double>::infinity();
  return students_t_quantile(0.975, degrees_of_freedom);
}

double chi_squared_tail(double x, double degrees_of_freedom) {
  return math::cdf(math::complement(ChiSquared(degrees_of_freedom), x));
}

double chi_squared_quantile(double p, double degrees_of_freedom) {
  return math::quantile(ChiSquared(degrees_of_freedom), p);
}

double fisher_f_tail(double f, double numerator_dof, double denominator_dof) {
  return math::cdf(math::complement(FisherF(numerator_dof, denominator_dof), f));
}

double beta_tail(double x, double alpha, double beta) {
  return math::cdf(math::complement(Beta(alpha, beta), x));
}

double beta_quantile(double p, double alpha, double beta) {
  return math::quantile(Beta(alpha, beta), p);
}

double beta_tail_quantile(double p, double alpha, double beta) {
  return math::quantile(math::complement(Beta(alpha, beta), p));
}

}  // namespace awmr
