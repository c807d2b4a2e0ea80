// Executes `awmr pil`: builds the firmware, runs it on chip and host, compares, checks the bounds.
#pragma once

#include "awmr/model/record.h"

#include <functional>
#include <string>
#include <string_view>

#include "awmr/core/progress.h"
#include "awmr/core/result.h"
#include "pil_options.h"

namespace awmr::pil {

struct Outcome {
  std::string summary;  ///< for stdout
  bool passed = false;
  std::string document;  ///< content of pil.json
  std::vector<Finding> findings = {};
};

/// Progress callbacks. `doing` is called with a description when a new stage begins, such as
/// compiling. `progress` is called with the number of steps done and their total number.
struct Watch {
  std::function<void(std::string_view)> doing = [](std::string_view) {};
  Progress progress = {};
};

/// Executes `awmr pil` and writes pil.json. A failed check is no error: Outcome::passed is then
/// false. Errors: an input is invalid; there is no compiler; the chip or the link fails.
Result<Outcome> run_pil(const cli::PilOptions& options, const Watch& watch);

}  // namespace awmr::pil
