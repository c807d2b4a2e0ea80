/// Detects logs in which the force columns contain set-points of a speed controller, not forces.
/// Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/family_fit.h"

namespace awmr {

/// Result of find_speed_control().
struct SpeedControl {
  double speed_per_command_mps = 0.0;  ///< speed of each wheel divided by its command, m/s
  bool withdraws = false;              ///< true: the intervals of the fit are not valid
};

/// Decides whether the speed at which each wheel rolls seems to be proportional to its command.
/// Either motor drag is then the only resistance, or the log has the set-points of a speed
/// controller instead of forces. One of these signs suffices:
///   - Both fitted resistances are linear, and the yaw coefficient a3 is d^2 times the surge
///     coefficient a1 (d: half of the track width):
///
///         tau_speed = a1 u,   tau_turn = a3 r = d^2 a1 r
///
///   - The measured steady speeds of the wheels are proportional to their commands. If the fit
///     has no model error (LogFit::has_model_error()), only speeds in turns with different commands
///     left and right count: for a vehicle without speed controller, inner and outer wheels then
///     have different ratios, unless its only resistance is motor drag.
///
/// The second sign withdraws the intervals, unless all of this indicates motor drag: the model
/// describes the logs, its errors are hardly larger than the sensor noise (LogFit::relative_error
/// below 1.5), and the first sign is present too.
std::optional<SpeedControl> find_speed_control(const Vehicle& vehicle,
                                               const std::vector<DrivingLog>& logs,
                                               const FamilyFit& chosen);

Finding speed_control_finding(const SpeedControl& found, const std::string& file);

}  // namespace awmr
