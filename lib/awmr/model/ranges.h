/// Valid ranges of the numbers in vehicle.json, model.json and gains.json, listed in VEHICLES.md of
/// this folder. They are wider than any vehicle needs: they only detect a wrong unit or a damaged
/// file.
#pragma once

#include "awmr/core/number_rule.h"
#include "awmr/model/parameters.h"
#include "awmr/model/resistance.h"

namespace awmr {

inline constexpr NumberRule kMass_kg{.min = 1e-3, .max = 1e6};
inline constexpr NumberRule kSize_m{.min = 1e-3, .max = 1e3};
inline constexpr NumberRule kYawInertia_kgm2{.min = 1e-9, .max = 1e9};
inline constexpr NumberRule kServoRate_degps{.min = 1e-3, .max = 1e6};
inline constexpr NumberRule kServoTime_s{.min = 1e-6, .max = 1e3};
inline constexpr NumberRule kSampleTime_s{.min = 1e-4, .max = 1.0};
/// Standard deviations of sensors, each in its own unit.
inline constexpr NumberRule kSensorNoise{.min = 0.0, .max = 1e3};
/// Latency of a sensor, or lag of a motor.
inline constexpr NumberRule kLatency_s{.min = 0.0, .max = 1.0};
/// Correlation time of a sensor's noise; 0: independent readings.
inline constexpr NumberRule kCorrelation_s{.min = 0.0, .max = 1e3};
inline constexpr NumberRule kStallPower_w{.min = 0.0, .max = 1e6, .min_excluded = true};
/// Range of the back-EMF k_e. With the largest k_e, 1000 s/m, a motor under full voltage has no
/// force left at a speed of 1/k_e = 1 mm/s.
inline constexpr NumberRule kBackEmf_s_per_m{.min = 0.0, .max = 1e3};
inline constexpr NumberRule kFastestTurn_degps{.min = 1e-3, .max = 1e6};
/// Coefficients of resistance, mass m' and yaw inertia I'z, each in its own unit.
inline constexpr NumberRule kCoefficient{.min = 1e-9, .max = 1e9};
/// Optional terms of the model (ParameterInfo::term): Coulomb, quadratic, back-EMF.
inline constexpr NumberRule kTerm{.min = 0.0, .max = 1e9};
/// Dead zone of a wheel's command, relative to the largest command.
inline constexpr NumberRule kCommandDeadZone{.min = 0.0, .max = 1.0, .max_excluded = true};
inline constexpr NumberRule kExponent{.min = 0.0, .max = 20.0};
/// Tyres. The range of the friction coefficient includes ice and rubber on dry asphalt. The range
/// of the cornering stiffness over load includes soft tyres and rigid wheels.
inline constexpr NumberRule kTyreFrictionRule{.min = 0.01, .max = 5.0};
inline constexpr NumberRule kCorneringStiffnessRule_per_rad{.min = 0.1, .max = 100.0};
inline constexpr NumberRule kGain{.min = 1e-9, .max = 1e9};
inline constexpr NumberRule kFrictionWidth_radps{.min = feed_forward_rest_speed<double>(),
                                                 .max = 1e3};
/// Bandwidth of a disturbance observer, rad/s. check_observer_rate() has a second limit:
/// 1/sample_time_s.
inline constexpr NumberRule kObserverBandwidth{.min = 1e-6, .max = 1e4};
inline constexpr NumberRule kObserverLimit{.min = 1e-9, .max = 1e6};

/// The valid range of a parameter in model.json. The equations have narrower bounds, given at the
/// fields in dynamics.h and resistance.h.
NumberRule rule_of(ParameterId id);

}  // namespace awmr
