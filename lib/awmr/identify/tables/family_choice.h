/// The nonlinear fits side by side, and which of them is used. Private to identify/.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/identify/tables/subject.h"

namespace awmr {

struct SubjectOptions {
  Method method = Method::kLogLinear;
  /// None: time where every run was timed, else speed.
  std::optional<ErrorModel> noise;
  /// A nonlinear fit was requested with this noise: that is where the error lies. Else it is one of
  /// several places.
  bool knows_noise = false;
  FamilyChoice family;
  Loss loss = Loss::kSquared;
  bool side_by_side = true;     ///< false: the requested fit alone, without alternatives
  bool keeps_outliers = false;  ///< a run far off the others' curve is fitted with them
};

/// A nonlinear fit of one family under one noise model, and its entry of /estimates.
struct FamilyCandidate {
  SteadyProblem problem;
  SteadyFit fit;
  EstimatorReport report;
};

bool all_timed(const std::vector<SteadyPoint>& points);

/// Quantity with the error in the nonlinear fit.
ErrorModel wanted_noise(const Subject& subject, const SubjectOptions& options);

/// Side by side: the power law under every noise model, the other families under the wanted one.
/// Else only what may be chosen. Families with more numbers than there are runs are left out.
/// `line`: the fit of the power law through the logarithms, their initial guess.
std::vector<FamilyCandidate> fit_candidates(const Subject& subject, const SubjectOptions& options,
                                            ErrorModel wanted, const SteadyFit& line);

/// The fit of a family under a noise model; null where there is none.
const FamilyCandidate* candidate_of(const std::vector<FamilyCandidate>& candidates, Family family,
                                    ErrorModel noise);

/// Minimum AICc among the fits that converged; the family with fewer terms where two are equal.
/// Null where no fit has one.
const FamilyCandidate* best_candidate(const std::vector<FamilyCandidate>& candidates,
                                      ErrorModel noise);

/// Description of a fit by noise, family and loss: "nonlinear, noise on time, coulomb-power,
/// Huber".
std::string method_in_words(const SteadyProblem& problem);

}  // namespace awmr
