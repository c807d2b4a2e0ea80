/// Nonlinear fits of a table under all resistance families (forms of the resistance law) and error
/// models, and the selection of one of them. Private to identify/.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/identify/tables/subject.h"

namespace awmr {

/// Options of the fit of a surge or turning table.
struct SubjectOptions {
  Method method = Method::kLogLinear;
  /// Quantity that has the measurement error in nonlinear fits. Absent: the time if every run was
  /// timed, else the speed.
  std::optional<ErrorModel> noise;
  /// True if the user requested a nonlinear fit with `noise`. If false, intervals average over all
  /// error models (noise_average.h).
  bool knows_noise = false;
  FamilyChoice family;
  Loss loss = Loss::kSquared;
  /// If false, only the requested fit is made, without fits for comparison.
  bool side_by_side = true;
  bool keeps_outliers = false;  ///< true keeps gross outliers in the fit
};

/// A nonlinear fit of one family under one error model, with its report for /estimates.
struct FamilyCandidate {
  SteadyProblem problem;
  SteadyFit fit;
  EstimatorReport report;
};

/// True if every run has a distance or an angle, and the time for it.
bool all_timed(const std::vector<SteadyPoint>& points);

/// True if every run was timed and the table has no other measurement of the rate: the rate is the
/// distance or the angle divided by the time. The error of the stop-watch is then the expected one.
bool only_timed(const std::vector<SteadyPoint>& points);

/// The requested error model; if none was requested, time if all runs were timed, else speed. The
/// relative error of the force that identify() assumes for another family than the power law is
/// replaced by the error of the time if the runs were only_timed().
ErrorModel wanted_noise(const Subject& subject, const SubjectOptions& options);

/// Makes the nonlinear fits of a table. With `options.side_by_side`: the power law under the error
/// models force, speed, time (if all runs were timed) and `wanted`, and the other families under
/// `wanted`. Without: only the families that can be selected, under `wanted`. Skips families with
/// more parameters than runs. `line`: log-linear fit of the power law, used as initial guess.
std::vector<FamilyCandidate> fit_candidates(const Subject& subject, const SubjectOptions& options,
                                            ErrorModel wanted, const SteadyFit& line);

/// Fits all families under the error model `noise`, without reports. The first is `first`. Skips
/// families with more parameters than runs.
std::vector<FamilyCandidate> fit_families(const Subject& subject, ErrorModel noise, Family first);

/// The fit of a family under an error model; null if there is none.
const FamilyCandidate* candidate_of(const std::vector<FamilyCandidate>& candidates, Family family,
                                    ErrorModel noise);

/// The converged fit with the smallest AICc among the fits under the error model `noise`. Of fits
/// with equal AICc, returns the first. Null if no fit has an AICc, for example because there are
/// too few runs.
const FamilyCandidate* best_candidate(const std::vector<FamilyCandidate>& candidates,
                                      ErrorModel noise);

/// Describes a fit by its error model, family and loss: "nonlinear, noise on time, coulomb-power,
/// Huber".
std::string method_in_words(const SteadyProblem& problem);

}  // namespace awmr
