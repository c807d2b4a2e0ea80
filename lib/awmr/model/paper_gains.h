/// The gains that the paper prints.
#pragma once

#include "awmr/model/gains.h"

namespace awmr {

/// The gains printed in the paper: lambda 3, mu 50, epsilon 12.                         [paper 4.1]
/// It prints no mu_s and epsilon_s. Those here, 5 and 1.2, are this project's choice: their ratio
/// is that of the heading loop's mu and epsilon.
inline constexpr Gains<double> kPaperGains{{3.0, 50.0, 12.0}, {5.0, 1.2}};

}  // namespace awmr
