/// Scenarios of the paper's runs with guidance (C8 to C12), compiled into the program. Private to
/// validate/.
#pragma once

#include <vector>

#include "awmr/core/files/embedded_file.h"

namespace awmr {

/// Returns these files of configs/paper/scenarios/. Each has its name without ".json" as path. The
/// paper does not print the acceptance radius of the waypoints, the approach angle of the
/// line-following law and the parameters of obstacle avoidance: this project chose them. The
/// minimum manoeuvring distance is the turning radius of the steering mode (5 m at any speed), plus
/// 1 m, plus the distance driven in 1 s.
///     c8_waypoints                                                         [paper 5.1]
///     c9_line                                                              [paper 5.2.1]
///     c10_obstacle_on_line (figure 43), c10_obstacle_between_waypoints (44)    [paper 5.2.2]
///     c11_lissajous, c11_lissajous_closed (with position feedback)         [paper (116)-(118)]
///     c12_waypoints_and_line: the waypoints of C8 as a polyline
const std::vector<EmbeddedFile>& paper_scenario_files();

}  // namespace awmr
