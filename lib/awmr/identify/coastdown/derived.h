/// m' from stop times, and plausibility checks of m' and I'z. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// ln m' with its sensitivity and variance.
struct MassFromStopTime {
  double log_mass_norm = 0.0;
  /// d ln m' by SteadyFit::free of the surge fit. For a power law d/d ln a1 = 1 and
  /// d/d b1 = -1/(1 - b1) + mean ln u_max.
  Eigen::VectorXd by_surge;
  double timing_variance = 0.0;  ///< of ln m': scatter of the runs, or the timing error of a single
                                 ///< one
};

/// t_a = m' int_0^u dw/g1(w), so m' = t_a / int; ln m' is averaged over the runs. For a power law
/// m' = (1 - b1) a1 t_a / u_max^(1 - b1). [paper (60)] Empty if the law never stops the vehicle.
/// Precondition: at least one run.
std::optional<MassFromStopTime> mass_from_stop_time(const SteadyFit& surge,
                                                    const std::vector<StopTimeRow>& runs);

/// Findings about m' from stop times: `implausible-deceleration`, `fragile-mass`,
/// `single-stop-time`.
void check_mass(const Resistance<double>& surge, const TrialSet<StopTimeRow>& coastdown,
                double mass_kg, double mass_norm, std::optional<double> relative_std_error,
                std::vector<Finding>& findings);
/// `implausible-deceleration` if a curve begins with a deceleration above that of any tyre:
/// g1(u)/m' > g.
void check_mass(const Resistance<double>& surge, const std::vector<CoastCurve>& curves,
                double mass_norm, std::vector<Finding>& findings);

/// True if the initial deceleration |u_dot| = g1(u)/m' from this speed is above g.
bool is_implausible(const Resistance<double>& surge, double speed_mps, double mass_norm);
/// The m' at which the initial deceleration from this speed equals mu g, the limit of tyres with mu
/// = kTyreFriction:
///   m' = g1(u)/(mu g)
double mass_norm_by_grip(const Resistance<double>& surge, double speed_mps);

/// `inertia-mismatch`: the measured Iz differs by a large factor from that of a uniform box.
void check_inertia(const Vehicle& vehicle, std::vector<Finding>& findings);

}  // namespace awmr
