/// Detects logs in which the force columns contain set-points of a speed controller, not forces.
/// Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/logs/log_stage.h"

namespace awmr {

/// Median ratio of the steady speeds of the wheels to their commands, m/s. Uses only speeds with a
/// standard error below 5 %. Empty in these cases, because the speeds are then not shown to be
/// proportional to the commands:
///   - There are fewer than six such speeds.
///   - Their commands differ by less than a factor of 3.
///   - A ratio differs from the median by more than 5 %. (A power law with the exponent b1 = 0.9
///     gives differences of 6 %.)
///   - The median is not positive.
std::optional<double> speed_per_set_point(const Vehicle& vehicle,
                                          const std::vector<DrivingLog>& logs);

/// Returns the warning `speed-controlled` if the speed at which each wheel rolls seems to be
/// proportional to its command. Either motor drag is then the only resistance, or the log has the
/// set-points of a speed controller instead of forces. One of these signs suffices:
///   - Both fitted resistances are linear, and the yaw coefficient a3 is d^2 times the surge
///     coefficient a1 (d: half of the track width):
///
///         tau_speed = a1 u,   tau_turn = a3 r = d^2 a1 r
///
///   - The model does not describe the logs (`model-inadequate`), and `set_point_mps`, the result
///     of speed_per_set_point(), is not empty.
std::vector<Finding> speed_control_findings(const Vehicle& vehicle,
                                            const std::vector<DrivingLog>& logs,
                                            const LogStage& stage,
                                            std::optional<double> set_point_mps);

}  // namespace awmr
