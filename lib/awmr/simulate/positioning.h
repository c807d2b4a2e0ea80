/// Position of the guidance from the sensors of one run. Private to this folder.
#pragma once

#include <cmath>
#include <optional>

#include "awmr/control/position_estimate.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/sensing.h"

namespace awmr {

/// The filter for the fixes of this receiver.
inline PositionFilter<double> position_filter_for(const Gps& gps, double sample_time_s) {
  const double steps_m2 = gps.x.quantum * gps.x.quantum / 12.0;
  return position_filter<double>(std::sqrt(gps.x.noise * gps.x.noise + steps_m2), gps.latency_s,
                                 sample_time_s);
}

/// The firmware's estimate if the scenario has a GPS and does not disable it; else the position as sensed.
class Positioning {
 public:
  Positioning(const Scenario& scenario, double sample_time_s) {
    if (!estimates_position(scenario)) return;
    estimate_.emplace(position_filter_for(*scenario.sensors->gps, sample_time_s));
  }

  /// The position at `t_s`. Call it once per sample, in order.
  Position<double> step(double t_s, const Sensed& sensed) {
    if (!estimate_) return sensed.position_m;
    return estimate_->step({sensed.position_m, t_s - sensed.fix_taken_s, sensed.is_fix_new},
                           sensed.motion);
  }

  /// Resets of the estimate so far.
  int resets() const { return estimate_ ? estimate_->resets : 0; }

 private:
  std::optional<PositionEstimate<double>> estimate_;
};

}  // namespace awmr
