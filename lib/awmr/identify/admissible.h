/// Check of the identified model: removes values that a model file cannot hold. Private to
/// identify/.
#pragma once

#include <map>
#include <string>

#include "awmr/model/model.h"

namespace awmr {

/// Removes the standard error, interval and quantiles of an estimate. Keeps its value.
void withdraw_uncertainty(Estimate& estimate);

/// Removes every fitted or derived value that is not finite or outside the range that model files
/// allow. Also removes the parameters that depend on a removed one, for example the exponent b1 if
/// a1 is removed. Removes an m' (mass over F_max) that was identified from tables if the upper end
/// of its 95 % interval is more than 10,000 times the lower end, because vehicles drawn from such
/// an interval cannot be simulated. Removes standard errors, intervals and covariances that are not
/// finite, with the warning `no-interval`. Never removes a value that the vehicle file gives.
/// Returns the reason for each removed value.
std::map<ParameterId, std::string> take_out_inadmissible(Model& model);

}  // namespace awmr
