/// Independent implementation, for the cross-check of `tune`, of the limits on gains that the
/// README of tune states.
#pragma once

#include <vector>

#include "peers/trade_off/heading_simulator.h"

namespace awmr::peers {

struct Limits {
  double margin = 0.8;  ///< epsilon/mu <= margin/lambda
  double damping = 0.7, late_damping = 0.25, delayed_damping = 0.05;
  double noise_share = 0.25;
  double steering_rate_degps = 0.0;  ///< largest RMS rate of the steering command, deg/s
};

/// Speed and largest yaw rate at which the limits are checked, m/s and rad/s.
struct Examined {
  double speed_mps = 0.0, fastest_radps = 0.0;
};

/// Largest violation of a limit by the model or a drawn body, relative to the limit; <= 0: all
/// limits are met. Stops at the first body that violates one.
double excess(const Controls& controls, const Geometry& vehicle, const SensorErrors& errors,
              const std::vector<Body>& bodies, const Limits& limits, const Examined& examined);

}  // namespace awmr::peers
