#pragma once

#include "awmr/control/autopilot_parts.h"

namespace awmr {

/// List of parts for a firmware without optional parts.
struct NoParts {
  typedef Disabled<LineFollower<float>> Line;
  typedef Disabled<PathFollower<float, uint32_t>> Path;
  typedef Disabled<SlowDown<float>> Arrival;
  typedef Disabled<Avoider<float>> Avoidance;
  typedef Disabled<Shaper<float>> Shaping;
  typedef Disabled<Observer> Observation;
  typedef Disabled<MotorCurve> Motors;
  typedef Disabled<GainsByMode> Gains;
  typedef Disabled<Positioner<>> Positioning;
  static constexpr CombinedSplit kSplit = CombinedSplit::kRedistribute;
  static constexpr bool kIsDirected = true;
};

}  // namespace awmr
