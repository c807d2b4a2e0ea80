/// Scenarios of the paper's runs with guidance (C8 to C12). A test checks that they equal the files
/// configs/paper/scenarios/c8* to c12*. Private to validate/.
#pragma once

#include "awmr/simulate/scenario.h"

namespace awmr {

Scenario waypoint_scenario();                    ///< C8                     [paper 5.1]
Scenario line_scenario();                        ///< C9                     [paper 5.2.1]
Scenario obstacle_on_line_scenario();            ///< C10, figure 43         [paper 5.2.2]
Scenario obstacle_between_waypoints_scenario();  ///< C10, figure 44         [paper 5.2.2]
Scenario lissajous_scenario(bool closed_loop);   ///< C11                    [paper (116)-(118)]
Scenario polyline_scenario();                    ///< C12: the waypoints of C8 as a polyline

}  // namespace awmr
