/// Trade-off between settling time and control variation. Private to tune/.
#pragma once

#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Returns the Pareto-optimal points: no other point has both a shorter settling time and a smaller
/// control variation. Sorted by settling time.
std::vector<TradeOffPoint> front_of(std::vector<TradeOffPoint> points);

/// Returns the Pareto front of `met`, the feasible gains of a search, and the points of named gains
/// such as the paper's (TradeOff::named), simulated in the runs of that search.
TradeOff trade_off_of(const Objective& searched, const ConstraintContext& context,
                      std::vector<TradeOffPoint> met, const Gains<double>& tuned,
                      const Gains<double>& baseline);

}  // namespace awmr
