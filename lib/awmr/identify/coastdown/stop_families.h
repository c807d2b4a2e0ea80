/// Comparison of resistance families on surge runs and stop times together, and the distribution of
/// m' over the families. Private to identify/.
///
/// m' from a stop time depends on the resistance g1 near rest, which surge runs do not measure: two
/// families that describe the runs equally well can give values of m' that differ by a factor of 2.
/// Stop times from different initial speeds tell the families apart, because their ratios depend on
/// the form of g1 but not on m'.
///
/// With the law theta of a family and its covariance C, the runs i give
///     v_i = ln t_i - ln T(u_i; theta) = ln m' + e_i,   B_i = d v_i/d theta,
/// where T is the stop time for m' = 1 and e_i the relative error of a stop time, with the standard
/// deviation s. The contrasts P'v of the n runs (P: n - 1 orthonormal columns that are orthogonal
/// to 1) do not depend on m'. They have the covariance
///     S = s^2 I + P'B C B'P.
/// Their likelihood is averaged over s, with a prior that is flat in ln s. If all runs have one
/// initial speed, B_i is the same for all runs, and the likelihood is that of every family.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/coastdown/mass.h"
#include "awmr/identify/tables/subject_fit.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// A family with its probability.
struct FamilyOfStops {
  const FamilyCandidate* candidate = nullptr;  ///< element of SubjectFit::compared
  /// AICc of the surge runs minus twice the logarithm of the likelihood of the stop times.
  double score = 0.0;
  double weight = 0.0;  ///< probability exp(-score/2), in [0, 1]; all add up to 1
};

/// Computes score and probability of each family of SubjectFit::compared under which the vehicle
/// stops. The first element is the chosen family. Empty if the runs of the surge law were not
/// compared, or if the vehicle never stops under the chosen family.
std::vector<FamilyOfStops> families_of_stops(const SubjectFit& surge,
                                             const std::vector<StopTimeRow>& stops);

/// Compares the families on surge runs and stop times together. Returns the family with the lowest
/// score, if its score is lower than that of the chosen family. Empty otherwise, and if the initial
/// speeds differ by less than 20 %.
std::optional<FamilyOfCurves> family_of_stops(const SubjectFit& surge,
                                              const std::vector<StopTimeRow>& stops);

/// Adds m' under the other families to `result.posterior` and to the reports of `result`, each with
/// the probability of its family, and sets `result.other_family`. The parameters of these families
/// have no counterpart in the chosen family, whose distribution therefore stays as it is; only ln m'
/// differs.
void average_over_families(const SubjectFit& surge, const std::vector<StopTimeRow>& stops,
                           MassResult& result);

}  // namespace awmr
