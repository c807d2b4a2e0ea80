/// Nonlinear fits of all families and noise models, and the selection of one. Private to identify/.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/identify/tables/subject.h"

namespace awmr {

struct SubjectOptions {
  Method method = Method::kLogLinear;
  /// Absent: time if every run was timed, else speed.
  std::optional<ErrorModel> noise;
  /// The user requested a nonlinear fit with this noise. If false, the noise model is uncertain.
  bool knows_noise = false;
  FamilyChoice family;
  Loss loss = Loss::kSquared;
  bool side_by_side = true;     ///< false: only the requested fit
  bool keeps_outliers = false;  ///< gross outliers are fitted with the other runs
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

/// With side_by_side: fits of the power law under every noise model and of the other families under
/// the chosen one. Otherwise only the fits that can be selected. Excludes families with more
/// parameters than runs. `line`: the log-linear fit of the power law, used as initial guess.
std::vector<FamilyCandidate> fit_candidates(const Subject& subject, const SubjectOptions& options,
                                            ErrorModel wanted, const SteadyFit& line);

/// The fit of a family under a noise model; null if there is none.
const FamilyCandidate* candidate_of(const std::vector<FamilyCandidate>& candidates, Family family,
                                    ErrorModel noise);

/// The converged fit with the minimum AICc; of equal ones, the family with fewer terms. Null if no
/// fit has an AICc.
const FamilyCandidate* best_candidate(const std::vector<FamilyCandidate>& candidates,
                                      ErrorModel noise);

/// Description of a fit by noise, family and loss: "nonlinear, noise on time, coulomb-power,
/// Huber".
std::string method_in_words(const SteadyProblem& problem);

}  // namespace awmr
