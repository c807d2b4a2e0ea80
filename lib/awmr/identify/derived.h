/// m', I'z and what makes them doubtful. Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/power_law_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// ln m' and its derivatives by what it was made from.
struct MassFromStopTime {
  double log_mass_norm = 0.0;
  double by_beta = 0.0;  ///< d ln m'/d b1 = -1/(1 - b1) + mean ln u_max; d ln m'/d ln a1 = 1
  double timing_variance = 0.0;  ///< of ln m' from the scatter of the runs; 0 for one run
};

/// m' = (1 - b1) a1 t_a / u_max^(1 - b1), the mean of its logarithm over the runs.      [paper
/// (60)] Precondition: b1 < 1, at least one run.
MassFromStopTime mass_from_stop_time(const PowerLawFit& surge,
                                     const std::vector<StopTimeRow>& runs);

/// Findings about a vehicle that stops as fast as this: `implausible-deceleration`,
/// `fragile-mass`, `single-stop-time`.
void check_mass(const PowerLawFit& surge, const TrialSet<StopTimeRow>& coastdown, double mass_kg,
                double mass_norm, std::optional<double> relative_std_error,
                std::vector<Finding>& findings);

/// `inertia-mismatch`: a measured Iz far from the uniform box's.
void check_inertia(const Vehicle& vehicle, std::vector<Finding>& findings);

}  // namespace awmr
