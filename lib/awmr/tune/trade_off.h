/// Trade-off between settling time and control variation. Private to tune/.
#pragma once

#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Pareto-optimal points, by settling time.
std::vector<TradeOffPoint> front_of(std::vector<TradeOffPoint> points);

/// The Pareto front of the points that a search evaluated, and the named gains on its draws.
TradeOff trade_off_of(const Objective& searched, const ConstraintContext& context,
                      std::vector<TradeOffPoint> met, const Gains<double>& tuned,
                      const Gains<double>& baseline);

}  // namespace awmr
