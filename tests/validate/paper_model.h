/// Adds trials of the paper's tables to its model.
#pragma once

#include "support/paper_vehicle.h"

namespace awmr::testing {

/// Adds four of the printed rows: two surge runs (tau_speed, m/s), a turn (tau_turn in m, rad/s)
/// and a coast-down (m/s, s).
inline void add_paper_trials(Model& model) {
  model.record.trials = {{TrialKind::kSurge, "surge.csv", 3, 0.2, 0.12, {}},
                         {TrialKind::kSurge, "surge.csv", 12, 2.0, 1.66, {}},
                         {TrialKind::kTurning, "turning.csv", 4, 0.064, 0.15, {}},
                         {TrialKind::kCoastdown, "coastdown.csv", 4, 1.66, 0.573, {}}};
}

}  // namespace awmr::testing
