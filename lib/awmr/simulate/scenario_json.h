/// Readers of the parts of scenario.json. Private to this folder; include from .cpp files only.
#pragma once

#include "awmr/core/json.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// `document` is the whole file, for arrays of points.
Guidance read_guidance(JsonObject json, const Json& document);
std::vector<Obstacle<double>> read_obstacles(JsonObject& scenario);
Avoidance<double> read_avoidance(JsonObject json);
HeadingShaping<double> read_shaping(JsonObject json);
/// disturbance, faults, slippery, battery, sensors, actuators, control, corner: those there are.
void read_world(JsonObject& json, Scenario& scenario);

}  // namespace awmr
