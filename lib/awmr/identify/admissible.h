/// Final check of a model before it is returned. Private to identify/.
#pragma once

#include <map>
#include <string>

#include "awmr/model/model.h"

namespace awmr {

/// Removes standard error, interval and quantiles; the value stays.
void withdraw_uncertainty(Estimate& estimate);

/// Removes from the model every fitted or derived value that is not finite or outside the range of
/// a model file, and the parameters that have no meaning without it: the exponent without its
/// factor, m' without the surge law. Removes an m' from tables whose 95 % interval spans more than
/// a factor of 10,000. Removes non-finite standard errors, intervals and covariances. Returns the
/// reasons, by parameter.
std::map<ParameterId, std::string> take_out_inadmissible(Model& model);

}  // namespace awmr
