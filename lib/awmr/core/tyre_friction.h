/// Default tyre parameters, for tyres that were not measured. Friction and cornering stiffness are
/// divided by the load on the tyre.
#pragma once

namespace awmr {

/// mu, dimensionless: friction coefficient of rubber on a dry floor or road. J. Y. Wong, "Theory of
/// Ground Vehicles", table 1.3, gives 0.75 to 0.9 for dry asphalt and concrete, 0.5 to 0.8 for wet
/// asphalt and concrete, and 0.6 for gravel. Smooth or dusty floors may have less.
inline constexpr double kTyreFriction = 0.8;

/// c_a, cornering stiffness over load, 1/rad: the slope of the side force, divided by the load, at
/// a small slip angle. Pneumatic tyres have about 5 to 15 (0.09 to 0.26 per degree) at their design
/// load. Tyres of small robots are hardly ever measured.
inline constexpr double kCorneringStiffness_per_rad = 10.0;

/// v_0, m/s, chosen far below driving speeds. The slip of a tyre is its sideways speed divided by
/// sqrt(w^2 + v_0^2), where w is its rolling speed. v_0 prevents a division by 0 for a tyre at
/// rest.
inline constexpr double kTyreRestSpeed_mps = 0.1;

}  // namespace awmr
