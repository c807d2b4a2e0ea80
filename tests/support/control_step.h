#pragma once
// One sample of the controller for a given reference. Freestanding C++14, because tests/firmware
// compiles it for the AVR.
#include "awmr/control/control_step.h"
#include "awmr/control/heading_law.h"
#include "awmr/control/speed_law.h"

namespace awmr {

/// Surge force and yaw moment that the laws request, and the commands that the allocation computes.
template <class T>
struct Command {
  /// requested surge force, dimensionless, forward positive, before any limit
  T tau_speed;
  /// requested yaw moment divided by F_max, m, counter-clockwise positive, before any limit
  T tau_turn_m;
  Allocation<T> allocation;  ///< wheel forces and steering angle, within their limits
};

/// Computes the heading law, the speed law and the allocation for one sample. Does not use
/// disturbance observers, and does not compensate the motors' dead zone.
template <class T, class G>
Command<T> control_step(const Controller<T, G>& c, YawMode mode, const Measurement<T>& m,
                        const Reference<T>& ref) {
  const PreparedController<T, G> laws = prepared(c);
  Command<T> command{};
  command.tau_speed = speed_law(laws, m, ref);
  command.tau_turn_m = heading_law(laws, m, ref);
  command.allocation = allocate(mode, command.tau_speed, command.tau_turn_m, c.limits, m.u_mps);
  return command;
}

}  // namespace awmr
