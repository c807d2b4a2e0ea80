/// Computes the position that the guidance uses from the sensors of a simulated run. Private to
/// this folder.
#pragma once

#include <cmath>
#include <optional>

#include "awmr/control/position_estimate.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/sensing.h"

namespace awmr {

/// Standard deviation of a fix on each axis, m, caused by noise and quantisation.
inline double fix_noise_m(const Gps& gps) {
  return std::sqrt(gps.x.noise * gps.x.noise + gps.x.quantum * gps.x.quantum / 12.0);
}

/// Computes the position for the guidance. If the scenario has a GPS, this is the position estimate
/// of the firmware, or the last fix if the scenario disables the estimate. Else it is the true
/// position.
class Positioning {
 public:
  Positioning(const Scenario& scenario, double sample_time_s) {
    if (!estimates_position(scenario)) return;
    const Gps& gps = *scenario.sensors->gps;
    estimate_.emplace(position_filter<double>(fix_noise_m(gps), gps.latency_s, sample_time_s));
  }

  /// Returns the position at the time `t_s`. Call it once per sample, in order.
  Position<double> step(double t_s, const Sensed& sensed) {
    if (!estimate_) return sensed.position_m;
    return estimate_->step({sensed.position_m, t_s - sensed.fix_taken_s, sensed.is_fix_new},
                           sensed.motion);
  }

  /// Number of resets of the estimate so far.
  int resets() const { return estimate_ ? estimate_->resets : 0; }

 private:
  std::optional<PositionEstimate<double>> estimate_;
};

}  // namespace awmr
