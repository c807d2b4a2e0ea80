/// The program under test, run from the source directory so that the README's paths hold.
#pragma once

#include "support/process.h"

namespace awmr::testing {

inline ProcessResult awmr(const std::string& arguments) {
  return run_process(std::string(AWMR_PROGRAM) + " " + arguments, AWMR_SOURCE_DIR);
}

}  // namespace awmr::testing
