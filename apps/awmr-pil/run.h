// The whole of `awmr pil`: build, run, compare, judge.
#pragma once

#include <string>

#include "awmr/core/result.h"
#include "pil_options.h"

namespace awmr::pil {

struct Outcome {
  std::string summary;  ///< for stdout
  bool passed = false;
  std::string document;  ///< the bytes of pil.json
};

/// Writes pil.json. Errors: bad input, no compiler, the chip or the link fails.
Result<Outcome> run_pil(const cli::PilOptions& options);

}  // namespace awmr::pil
