/// m' and I'z from coast-downs, by stop times, curves or both. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/coastdown/joint_fit.h"
#include "awmr/identify/coastdown/mass_estimate.h"
#include "awmr/identify/tables/subject_fit.h"

namespace awmr {

struct MassResult {
  std::optional<MassEstimate> estimate;  ///< main value, by the chosen surge law
  /// Coordinates: SteadyFit::free of the surge law, then ln m'. Empty if the surge fit has no
  /// covariance. Excludes laws that never stop the vehicle.
  Posterior posterior;
  std::optional<double> by_grip;  ///< Model::mass_norm_by_grip
  std::optional<JointFit> joint;  ///< if requested and usable
  std::optional<CoastFit> alone;  ///< curves without a surge law
  std::string reason;             ///< why there is no estimate
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
};

/// Precondition: at least a stop time or a curve. `surge` is null if its law is not identified.
/// Curves without a deceleration are excluded (`no-deceleration`). Without a surge law, `family` is
/// fitted to the curves alone, and compared with the other families unless it was requested
/// (`power-law-inadequate`).
MassResult estimate_mass(const SubjectFit* surge, const std::optional<TrialSet<StopTimeRow>>& stops,
                         const std::vector<CoastCurve>& curves, const Vehicle& vehicle,
                         const FamilyChoice& family, bool joint);

}  // namespace awmr
