// The whole of `awmr pil`: build, run, compare, judge.
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
  std::string document;  ///< the bytes of pil.json
  std::vector<Finding> findings = {};
};

/// Is told what is being done, and how far it is.
struct Watch {
  std::function<void(std::string_view)> doing = [](std::string_view) {};
  Progress progress = {};
};

/// Writes pil.json. Errors: bad input, no compiler, the chip or the link fails.
Result<Outcome> run_pil(const cli::PilOptions& options, const Watch& watch);

}  // namespace awmr::pil
