/// Estimation of the motors' back-EMF k_e from logs. Private to identify/.
///
/// While the motors drive, back-EMF cannot be separated from a linear resistance. Straight ahead,
///     m' du/dt = n (F' - k_e u) - g1(u)
/// (n: number of driven wheels; F': force of one wheel at rest under its command, over F_max; k_e
/// in s/m.) With the motors off, only g1 acts. To identify k_e, logs must contain driving and
/// coasting.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// Reason why these logs cannot separate k_e from the resistance. Empty if all logs together have
/// at least a second of coasting (both forces 0), counted only within 3 s after driving.
std::string why_no_back_emf(const std::vector<DrivingLog>& logs);

/// Returns the options with k_e free, and with an initial guess of k_e if there was none.
LogFitOptions with_back_emf(LogFitOptions options);

/// True if a further fit should also estimate k_e. One of these reasons suffices: the score test of
/// k_e predicts a decrease of -2 ln L above 4; a slow drift of a channel may hide k_e; `fit` did
/// not converge. False if k_e is not among `candidate_terms`, the terms that `fit` tested.
bool suspects_back_emf(const LogFit& fit, const std::vector<ParameterId>& candidate_terms);

/// True if the fit with k_e lowers AIC by more than kFamilyAicThreshold and identifies k_e.
bool shows_back_emf(const FamilyFit& with, const FamilyFit& without);

/// The warning `back-emf`: reports that the model with k_e is used, the value of k_e, and the
/// decrease of AIC.
Finding back_emf_finding(const std::string& file, const FamilyFit& with, const FamilyFit& without);

}  // namespace awmr
