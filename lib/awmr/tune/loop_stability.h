/// Stability of the heading and the speed loop of a vehicle with given gains: linearised and
/// sampled, with latency and motor lag.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"
#include "awmr/simulate/conditions.h"

namespace awmr {

/// A loop that is unstable.
struct UnstableLoop {
  /// Name and operating point, such as "heading loop in mode steering at 12 deg/s".
  std::string name;
  /// The cause: formula of the rate of its law, such as "mu/epsilon", or the bandwidth of the
  /// disturbance observer if the loop is stable without observer.
  std::string rate_name;
  double rate = 0.0;  ///< value of the cause
  std::string unit = "1/s";
};

/// Returns the unstable loops of the identified vehicle: at most one heading loop and the speed
/// loop. They are linearised as in `tune` (SampledHeadingLoop), at the yaw rates and the speed of
/// the default tuning scenario. Latency and motor lag are those of `conditions`. `mode`: the mode
/// in which the gains are used; absent: all modes of the vehicle. Returns nothing if the model
/// lacks a parameter of these loops.
std::vector<UnstableLoop> unstable_loops(const Model& model, const ModeGains& gains,
                                         const LoopConditions& conditions,
                                         std::optional<YawMode> mode = {});

}  // namespace awmr
