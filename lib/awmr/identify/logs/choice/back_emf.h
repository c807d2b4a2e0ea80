/// Estimation of the motors' back-EMF k_e from logs. Private to identify/.
///
/// While the motors drive, back-EMF acts like a linear resistance, so the logs cannot separate the
/// two. Straight ahead,
///     m' du/dt = n (F' - k_e u) - g1(u)
/// with the number n of driven wheels, the force F' (over F_max) that the command gives one wheel
/// at standstill, and k_e in s/m. With the motors off, only the resistance g1 acts. Logs must
/// therefore contain both driving and coasting.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/choice/family_choice.h"

namespace awmr {

/// Returns the reason why these logs cannot separate the back-EMF k_e from the resistance. Empty if
/// all logs together contain at least 1 s of coasting (both forces 0). Only the first 3 s after
/// driving count as coasting, because the vehicle may stand still later.
std::string why_no_back_emf(const std::vector<DrivingLog>& logs);

/// Returns the options with the back-EMF k_e as an estimated parameter, and with an initial guess
/// of k_e if there was none.
LogFitOptions with_back_emf(LogFitOptions options);

/// If `fit` estimates the back-EMF k_e, returns the options with k_e as an estimated parameter.
/// Else returns them unchanged.
LogFitOptions with_back_emf_as_in(const FamilyFit& fit, LogFitOptions options);

/// True if a further fit should also estimate the back-EMF k_e, for one of these reasons:
///   - The score test of k_e (score_test.h) predicts that -2 ln L decreases by more than 4. Noise
///     alone gives such a prediction in about 2 % of fits.
///   - A channel has a slow drift, which may hide the effect of k_e.
///   - `fit` did not converge.
///
/// False if k_e is not one of `candidate_terms`, the terms that `fit` tested.
bool suspects_back_emf(const LogFit& fit, const std::vector<ParameterId>& candidate_terms);

/// True if `with`, the fit that estimates the back-EMF k_e, is better than `without`, the fit that
/// does not: `with` identifies a k_e that differs significantly from 0, and its AIC is lower by
/// more than kFamilyAicThreshold. False if a channel of `with` still has a large drift
/// (ChannelNoise::overwhelms_sensor()): something other than back-EMF, which the model lacks too,
/// may then cause the difference of AIC.
bool shows_back_emf(const FamilyFit& with, const FamilyFit& without);

/// Returns the warning `back-emf`: the fit uses the model with back-EMF, `with`. The text has the
/// value of k_e and the decrease of AIC.
Finding back_emf_finding(const std::string& file, const FamilyFit& with, const FamilyFit& without);

}  // namespace awmr
