/// awmr_params.h: the identified model and the tuned gains as a header for the AVR.
#pragma once

#include <string>

#include "awmr/core/result.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"

namespace awmr {

struct EmitInputs {
  std::string model_file;    ///< name, for messages
  std::string model_sha256;  ///< of its bytes
  std::string gains_sha256;
};

/// The bytes of awmr_params.h. Errors (input): the model lacks a parameter; a value that is not a
/// normal float32. Errors (refused): T2 >= T1.
Result<std::string> params_header(const Model& model, const Gains<double>& gains,
                                  const EmitInputs& inputs);

}  // namespace awmr
