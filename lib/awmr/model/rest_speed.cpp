#include <cmath>

#include "awmr/model/steady.h"

namespace awmr {

double rest_speed(const Resistance<double>& law, double inertia, double step_s) {
  if (law.coulomb > 0.0) {
    double w = law.coulomb * step_s / inertia;
    // Near the solution, each iteration multiplies the error by w g'(w)/g(w). This is small if
    // Coulomb friction dominates, as at the low speed w of a chord.
    for (int i = 0; i < 60; ++i) w = law.at(w) * step_s / inertia;
    return w;
  }
  if (law.beta >= 1.0) return 0.0;
  return std::pow(law.alpha * step_s / inertia, 1.0 / (1.0 - law.beta));
}

}  // namespace awmr
