/// Final check of a model before it is returned. Private to identify/.
#pragma once

#include <map>
#include <string>

#include "awmr/model/model.h"

namespace awmr {

/// Leaves the value without its standard error, interval and quantiles.
void withdraw_uncertainty(Estimate& estimate);

/// Takes every fitted or derived value out of the model that is not finite or outside of what a
/// model file may hold, with the parameters that depend on it: an exponent without its factor says
/// nothing, and m' nothing without the surge law. So does an m' of tables whose 95 % interval spans more than a
/// factor of 10,000. Standard errors, intervals and covariances that are not finite go
/// as well. Returns why, by parameter.
std::map<ParameterId, std::string> take_out_inadmissible(Model& model);

}  // namespace awmr
