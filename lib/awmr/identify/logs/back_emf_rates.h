/// Change of the rates by the back-EMF of the motors, for linear_rates(). Private to identify/.
#pragma once

#include "awmr/identify/logs/linear_rates.h"

namespace awmr {

/// Adds back-EMF to the rates. Call after the terms of the wheel forces and the resistance.
/// `left_on`, `right_on`: the motors of these wheels are on. `sin_d`, `cos_d`: sine and cosine of
/// the steering angle d_r.
void add_back_emf(const LinearPlant& plant, const State<double>& s, bool left_on, bool right_on,
                  double sin_d, double cos_d, LinearRates& out);

}  // namespace awmr
