/// Selection of the resistance families of a log fit, one for surge and one for yaw. A family is a
/// form of the resistance law, for example a power law. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/choice/family_screen.h"

namespace awmr {

/// Options of best_family(), which compares the families of a fit `first` with other families.
struct FamilyContest {
  OpenAxes open = {};  ///< axes (surge, yaw) whose family is compared; other axes keep theirs
  /// Another family replaces a power law only if its AIC is lower than that of the power law by
  /// more than this.
  double lead = 0.0;
  /// True: compares the families of an axis only if there is a reason: a score test (score_test.h)
  /// or a slow drift indicates a missing term; the fit did not converge; or the current family of
  /// the axis is not the power law.
  bool only_candidates = true;
};

/// Result of best_family().
struct BestFamily {
  FamilyFit best;
  std::vector<FamilyFit> others;  ///< the other fits that were made
  /// Findings `power-law-inadequate`, `family-undecided` and `families-not-compared`, if they
  /// apply.
  std::vector<Finding> findings;
  /// True: the limit of work (Effort) or time was reached before all families were compared.
  bool is_out_of_time = false;
};

/// Returns the reports of the fits for /estimates of model.json. All AIC are computed under the
/// noise model of `reference`, because AIC under different noise models are not comparable.
std::vector<EstimatorReport> reports_of(const std::vector<FamilyFit>& fits,
                                        const FamilyFit& reference);

/// Estimated number of fits of best_family(): one for each family of an axis that it compares. The
/// actual number can be larger, because families with a similar AIC are fitted again, and a change
/// of the surge family can add fits of the yaw families (and the reverse). The actual number is
/// smaller if the fits reach the limit of work or time.
std::size_t contender_count(const LogFitOptions& power_law, const FamilyFit& first,
                            const FamilyContest& contest);

/// Fits the resistance families one after the other and returns the best converged fit by AIC
/// (family_fit.h). Each fit starts from the best optimum so far, so that a family is never worse
/// than a simpler one that it contains. `first`: the fit to improve on, usually of power laws.
BestFamily best_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       FamilyFit first, const FamilyContest& contest);

}  // namespace awmr
