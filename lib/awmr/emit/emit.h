/// awmr_params.h: the identified model and the tuned gains as a header for the AVR.
#pragma once

#include <string>

#include "awmr/core/result.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"

namespace awmr {

struct EmitInputs {
  std::string model_file;    ///< as the user gave it
  std::string model_sha256;  ///< of its bytes
  std::string gains_sha256;
  std::string gains_file = "gains.json";
};

/// AWMR_PARAMS_SHA256: SHA-256 of the 128 characters that the model's and the gains' SHA-256 make
/// in lower-case hexadecimal, the model's first.
std::string params_sha256(const EmitInputs& inputs);

/// The bytes of awmr_params.h: C89 and C++98 and later, in ASCII. Each value is rounded to float32
/// once and written with nine significant digits, which read back to the same float.
/// Errors (input): the model lacks a parameter; a value is not a normal float32, or out of its
/// range (every such value at once). Errors (refused): T2 >= T1 as float32 sees it.
Result<std::string> params_header(const Model& model, const Gains<double>& gains,
                                  const EmitInputs& inputs);

}  // namespace awmr
