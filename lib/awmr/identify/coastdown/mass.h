/// Estimation of m', the mass divided by F_max, from coast-downs: stop times, curves or both.
/// Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/coastdown/joint_fit.h"
#include "awmr/identify/coastdown/mass_estimate.h"
#include "awmr/identify/tables/subject_fit.h"

namespace awmr {

/// Result of estimate_mass().
struct MassResult {
  std::optional<MassEstimate> estimate;  ///< reported m', under the chosen surge law
  /// Joint distribution of the surge law's free coordinates (SteadyFit::free) and ln m'. It is a
  /// mixture over the error models of the surge runs (which quantity has the measurement error), as
  /// far as their surge laws give an m'. Empty if the surge fit has no covariance.
  Posterior posterior;
  /// m' at the limit of the tyres' grip (mass_norm_by_grip()), if a coast-down begins with an
  /// implausible deceleration.
  std::optional<double> by_grip;
  std::optional<JointFit> joint;  ///< joint fit, if requested and converged
  std::optional<CoastFit> alone;  ///< fit of the curves, if there is no surge law
  /// Reason why the stop times, or the curves, determine no m' (the mass divided by F_max). Empty
  /// if neither failed. If only one of them failed, the other can still determine m': then both
  /// `reason` and `estimate` are set.
  std::string reason;
  /// m' under the most probable other family, as a sentence for `fragile-mass`. Empty if m' was not
  /// averaged over families.
  std::string other_family;
  std::vector<EstimatorReport> reports;
  std::vector<Finding> findings;
};

/// Family that surge runs and coast-down curves together describe best.
struct FamilyOfCurves {
  Family family = Family::kPower;
  double decrease = 0.0;  ///< AICc of the chosen family minus that of this family
};
/// Compares the families between which the surge runs do not decide (SubjectFit::undecided) on the
/// curves, see law_of_curves(). Empty if the chosen family describes the curves, or if no other
/// family lowers AICc by more than kFamilyAicThreshold.
std::optional<FamilyOfCurves> family_of_curves(const SubjectFit& surge,
                                               const std::vector<CoastCurve>& curves);

/// Estimates m' from stop times, curves or both. `surge` is null if the surge law is not
/// identified. Then `family` is fitted to the curves alone, and compared with the other families
/// unless the user requested it (`power-law-inadequate`). Excludes rows and curves that do not
/// measure a deceleration (measured_rows(), `no-deceleration`). If the residuals have a large slow
/// drift, or another m' fits nearly as well (CoastModel::withdraws_intervals()), m' gets no
/// posterior, and no joint fit is made. Further findings: `sensor-lag`, `model-inadequate`,
/// `estimates-disagree`, `noise-model`, `coloured-residuals`, `not-converged`, `back-emf-assumed`,
/// those of check_mass(). Precondition: at least one stop time or curve.
MassResult estimate_mass(const SubjectFit* surge, const std::optional<TrialSet<StopTimeRow>>& stops,
                         const std::vector<CoastCurve>& curves, const Vehicle& vehicle,
                         const FamilyChoice& family, bool joint);

}  // namespace awmr
