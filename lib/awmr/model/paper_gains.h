/// The gains that the paper prints.
#pragma once

#include "awmr/model/gains.h"

namespace awmr {

/// The gains printed in the paper: lambda 3, mu 50, epsilon 12.                         [paper 4.1]
/// The paper prints no mu_s and eps_s. The values 5 m/s^2 and 1.2 m/s are this project's choice;
/// their ratio equals mu/epsilon.
inline constexpr Gains<double> kPaperGains{{3.0, 50.0, 12.0}, {5.0, 1.2}};

}  // namespace awmr
