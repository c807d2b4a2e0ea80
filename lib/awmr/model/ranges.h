/// What the numbers of vehicle.json, model.json and gains.json may be: README.md beside this file
/// lists them. Wider than any vehicle, so that a unit that was taken for another, or a damaged
/// file, is found where it is read. Include from .cpp files only.
#pragma once

#include "awmr/core/json.h"
#include "awmr/model/parameters.h"

namespace awmr {

inline constexpr NumberRule kMass_kg{.min = 1e-3, .max = 1e6};
inline constexpr NumberRule kSize_m{.min = 1e-3, .max = 1e3};
inline constexpr NumberRule kYawInertia_kgm2{.min = 1e-9, .max = 1e9};
inline constexpr NumberRule kServoRate_degps{.min = 1e-3, .max = 1e6};
inline constexpr NumberRule kServoTime_s{.min = 1e-6, .max = 1e3};
inline constexpr NumberRule kSampleTime_s{.min = 1e-4, .max = 1.0};
/// Standard deviations of sensors, each in its own unit.
inline constexpr NumberRule kSensorNoise{.min = 0.0, .max = 1e3};
/// How late a sensor or a motor is.
inline constexpr NumberRule kLatency_s{.min = 0.0, .max = 1.0};
/// 1/k_e is the speed at which a motor under full voltage has no force left: 1 mm/s at the least.
inline constexpr NumberRule kStallPower_w{.min = 0.0, .max = 1e6, .min_excluded = true};
inline constexpr NumberRule kBackEmf_s_per_m{.min = 0.0, .max = 1e3};
inline constexpr NumberRule kFastestTurn_degps{.min = 1e-3, .max = 1e6};
/// Coefficients of resistance, m' and I'z, each in its own unit.
inline constexpr NumberRule kCoefficient{.min = 1e-9, .max = 1e9};
inline constexpr NumberRule kTerm{.min = 0.0, .max = 1e9};
inline constexpr NumberRule kExponent{.min = 0.0, .max = 20.0};
inline constexpr NumberRule kGain{.min = 1e-9, .max = 1e9};
/// Below 1/sample_time_s too, which is not known where gains are read.
inline constexpr NumberRule kObserverBandwidth{.min = 1e-6, .max = 1e4};
inline constexpr NumberRule kObserverLimit{.min = 1e-9, .max = 1e6};

/// The values of a parameter with which the equations of motion make sense: dynamics.h and
/// resistance.h have the bounds at their fields.
NumberRule rule_of(ParameterId id);

}  // namespace awmr
