/// The paper's vehicle as an identified model with 95 % intervals, for scenarios at a corner of
/// them.
#pragma once

#include "support/paper_vehicle.h"

namespace awmr::testing {

/// Model in which every parameter has an interval of +-10 %.
inline Model model_with_intervals() {
  Model model = fitted_paper_model();
  for (Estimate& estimate : model.estimates) {
    if (estimate.value) estimate.ci95 = Interval{0.9 * *estimate.value, 1.1 * *estimate.value};
  }
  return model;
}

}  // namespace awmr::testing
