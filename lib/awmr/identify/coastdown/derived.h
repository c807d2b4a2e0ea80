/// Mass m' from stop times, and plausibility checks of m' and of the yaw inertia I'z (both divided
/// by F_max). Private to identify/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "awmr/identify/tables/steady_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// m' from stop times, its derivatives with respect to the surge law, and the variance that the
/// errors of the stop times cause.
struct MassFromStopTime {
  double log_mass_norm = 0.0;  ///< ln m'
  /// d ln m' / d theta for the free coordinates theta of the surge fit (SteadyFit::free). For a
  /// power law, the derivative is 1 with respect to ln a1, and -1/(1 - b1) + mean ln u_max with
  /// respect to b1 (u_max: initial speed).
  Eigen::VectorXd by_surge;
  /// Variance of ln m' that the errors of the stop times cause. It follows from the scatter of the
  /// runs or, if there is a single run, from its timing error.
  double timing_variance = 0.0;
};

/// Computes m' from the time t_a in which a vehicle with the motors off stops from the speed u_max.
/// The surge resistance g1 gives t_a = m' int_0^u_max dw/g1(w).
/// For a power law m' = (1 - b1) a1 t_a / u_max^(1 - b1). [paper (60)]
/// Averages ln m' over the runs. Empty if the vehicle never stops under this law. Precondition: at
/// least one run.
std::optional<MassFromStopTime> mass_from_stop_time(const SteadyFit& surge,
                                                    const std::vector<StopTimeRow>& runs);

/// Adds the findings about m' from stop times, where they apply: `implausible-deceleration` (above
/// g), `fragile-mass` (standard error above 10 %), `single-stop-time`. `relative_std_error`:
/// standard error of m' divided by m'; if absent, `fragile-mass` is not checked.
void check_mass(const Resistance<double>& surge, const TrialSet<StopTimeRow>& coastdown,
                double mass_kg, double mass_norm, std::optional<double> relative_std_error,
                std::vector<Finding>& findings);
/// Adds `implausible-deceleration` for each curve whose initial deceleration g1(u)/m' is above g,
/// the acceleration of gravity, which a tyre cannot give.
void check_mass(const Resistance<double>& surge, const std::vector<CoastCurve>& curves,
                double mass_norm, std::vector<Finding>& findings);

/// True if a coast-down from `speed_mps` begins with a deceleration g1(u)/m' above g, the
/// acceleration of gravity (g1: surge resistance, m': mass, both divided by F_max).
bool is_implausible(const Resistance<double>& surge, double speed_mps, double mass_norm);
/// Returns the mass m' for which a coast-down from the speed u begins with the deceleration mu g,
/// the limit of tyres with the friction coefficient mu = kTyreFriction:
///   m' = g1(u)/(mu g)
double mass_norm_by_grip(const Resistance<double>& surge, double speed_mps);

/// Adds the note `inertia-mismatch` if the given Iz differs by more than 10 % from that of a
/// uniform box of the vehicle's size and mass.
void check_inertia(const Vehicle& vehicle, std::vector<Finding>& findings);

}  // namespace awmr
