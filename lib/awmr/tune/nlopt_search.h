/// NLopt searches over the points of a SearchSpace. Private to tune/.
#pragma once

#include <nlopt.h>

#include <algorithm>
#include <memory>

#include "awmr/tune/problem.h"

namespace awmr {

using Optimizer = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

/// Returns a search within the bounds of the space, with at most `evaluations` evaluations.
inline Optimizer optimizer(nlopt_algorithm algorithm, const SearchSpace& space, int evaluations) {
  Optimizer opt(nlopt_create(algorithm, space.dimension()), &nlopt_destroy);
  nlopt_set_lower_bounds(opt.get(), space.lower_corner().data());
  nlopt_set_upper_bounds(opt.get(), space.upper_corner().data());
  nlopt_set_maxeval(opt.get(), evaluations);
  return opt;
}

/// Returns a local search by COBYLA. Its first and its smallest step, in ln(gain), change each gain
/// by 20 % and by 0.1 %.
inline Optimizer local_optimizer(const SearchSpace& space, int evaluations) {
  Optimizer opt = optimizer(NLOPT_LN_COBYLA, space, evaluations);
  nlopt_set_initial_step1(opt.get(), 0.2);
  nlopt_set_xtol_abs1(opt.get(), 1e-3);
  return opt;
}

inline Point point_at(unsigned dimension, const double* x) {
  Point point{};
  std::copy(x, x + dimension, point.begin());
  return point;
}

}  // namespace awmr
