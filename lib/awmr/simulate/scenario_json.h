/// Readers of the parts of scenario.json, and the ranges of their numbers. Private to this folder;
/// include from .cpp files only.
#pragma once

#include "awmr/core/json/json.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

// Permitted ranges of the numbers in a scenario. They are wider than any task needs, and narrow
// enough that the simulation stays finite.
inline constexpr NumberRule kDuration_s{.min = 0.0, .max = 1e6, .min_excluded = true};
inline constexpr NumberRule kTime_s{.min = 0.0, .max = 1e6};
inline constexpr NumberRule kCoordinate_m{.min = -1e6, .max = 1e6};
inline constexpr NumberRule kLength_m{.min = 0.0, .max = 1e6, .min_excluded = true};
inline constexpr NumberRule kLengthOrNone_m{.min = 0.0, .max = 1e6};
inline constexpr NumberRule kSignedSpeed_mps{.min = -1e3, .max = 1e3};
inline constexpr NumberRule kSpeed_mps{.min = 0.0, .max = 1e3};
inline constexpr NumberRule kAngle_deg{.min = -1e12, .max = 1e12};
inline constexpr NumberRule kYawRate_degps{.min = -1e5, .max = 1e5};
/// Forces divided by F_max, and moments divided by F_max in m: up to a thousand times the largest
/// force of one motor.
inline constexpr NumberRule kForce{.min = -1e3, .max = 1e3};
inline constexpr NumberRule kForceSize{.min = 0.0, .max = 1e3};
inline constexpr NumberRule kRate{.min = 0.0, .max = 1e6, .min_excluded = true};
inline constexpr NumberRule kSignedRate_radps{.min = -1e3, .max = 1e3};
/// kSensorSize: noise and quantum of a sensor. kSensorBias: its bias. Both in the unit of the
/// sensor.
inline constexpr NumberRule kSensorSize{.min = 0.0, .max = 1e6};
inline constexpr NumberRule kSensorBias{.min = -1e6, .max = 1e6};

inline constexpr NumberRule kTyreRestSpeedRule_mps{.min = 0.01, .max = 10.0};

Guidance read_guidance(JsonObject& json);
Obstacle<double> read_obstacle(JsonObject& json);
Avoidance<double> read_avoidance(JsonObject& json);
HeadingShaping<double> read_shaping(JsonObject& json);
/// Reads disturbance, faults, slippery, battery, sensors, estimator, actuators, control, corner and
/// tyres, if present.
void read_world(JsonObject& json, Scenario& scenario);

}  // namespace awmr
