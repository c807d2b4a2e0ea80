/// Runs the program under test in the source directory, so that the paths of the READMEs are valid.
#pragma once

#include "support/process.h"

namespace awmr::testing {

inline ProcessResult awmr(const std::string& arguments) {
  return run_process(std::string(AWMR_PROGRAM) + " " + arguments, AWMR_SOURCE_DIR);
}

}  // namespace awmr::testing
