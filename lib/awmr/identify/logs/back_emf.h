/// Back-EMF of the motors as a free parameter of a log fit. Private to identify/.
///
/// While the motors drive, back-EMF cannot be separated from a linear resistance. Straight ahead,
///     m' du/dt = 4 (F' - k_e u) - g1(u)
/// and with the motors off only g1 acts. So k_e needs logs with both.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// Reason why these logs cannot separate k_e from resistance. Empty if the vehicle coasts for a
/// second or more, shortly after being driven.
std::string why_no_back_emf(const std::vector<DrivingLog>& logs);

/// The options with k_e free; its initial guess is set if it has none.
LogFitOptions with_back_emf(LogFitOptions options);

/// Whether k_e is free in a fit with these options.
bool frees_back_emf(const LogFitOptions& options);

/// Whether to fit with k_e free: its score test has a large gain, slow drift of a channel may hide
/// it, or the fit did not converge. Precondition: k_e is a candidate term of this fit.
bool suspects_back_emf(const LogFit& fit, const std::vector<ParameterId>& candidate_terms);

/// Whether a fit with k_e free is significantly better than one without, and identifies k_e.
bool shows_back_emf(const FamilyFit& with, const FamilyFit& without);

/// `back-emf`: the chosen model and the improvement of the fit.
Finding back_emf_finding(const std::string& file, const FamilyFit& with, const FamilyFit& without);

}  // namespace awmr
