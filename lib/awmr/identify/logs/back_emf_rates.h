/// Effect of the motors' back-EMF on the rates of the state, for linear_rates(). Private to
/// identify/.
#pragma once

#include "awmr/identify/logs/linear_rates.h"

namespace awmr {

/// Adds the effect of back-EMF to the rates. Call after the wheel forces and the resistance were
/// added. `left_on`, `right_on`: true if the motors of that side are on. `sin_d`, `cos_d`: sine and
/// cosine of the steering angle d_r.
void add_back_emf(const LinearPlant& plant, const State<double>& s, bool left_on, bool right_on,
                  double sin_d, double cos_d, LinearRates& out);

}  // namespace awmr
