/// Disturbances of the tests of the simulator.
#pragma once

#include "awmr/simulate/scenario.h"

namespace awmr::testing {

/// A constant disturbance that begins at `from_s`.
inline DisturbanceTerm constant(double value, double from_s = 0.0) {
  DisturbanceTerm term;
  term.value = value;
  term.window.from_s = from_s;
  return term;
}

}  // namespace awmr::testing
