/// Messages about runs that do not settle, for findings and errors. Private to tune/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/tune/tune.h"

namespace awmr {

/// "SCENARIO, MODE", or "MODE" if the scenario has no name.
std::string run_name(const std::string& scenario, YawMode mode);

struct UnsettledText {
  std::string text;
  std::string pointer;  ///< place in tune.json that the advice is about; may be empty
};

/// Returns a message for each advice, with all scenarios and modes that get this advice, and the
/// shares of their runs that settle: "of the runs with the tuned gains, 40 % (SCENARIO, MODE), 0 %
/// (...) settle after every heading step. ADVICE".
std::vector<UnsettledText> unsettled_texts(std::span<const UnsettledRuns> unsettled);

}  // namespace awmr
