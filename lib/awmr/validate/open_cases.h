/// Settings that the paper leaves open, and their effect on its claims. Private to this folder.
///
/// The paper prints neither the limits of F' nor a method to share the moment of the combined mode.
/// Its allocation is for small angles, and its m' requires more tyre force than friction permits.
/// The cases are all combinations of
///
///     allocation   exact, paper (control/allocation.h)
///     F'           [-1, 1], [0, 1] (the paper's own normalisation), [0, 0.5]
///     m', I'z      times 1, and times the factor with which tau_speed = 2 needs a friction of 0.8:
///                  2 F_max <= 0.8 m g with F_max = m/m'  =>  m' >= 2/(0.8 g)
///     split        redistribute, fixed half
#pragma once

#include <optional>
#include <vector>

#include "awmr/core/progress.h"
#include "awmr/validate/claims.h"

namespace awmr {

/// All combinations; only the mass factor 1 if the model's own m' is within the friction.
std::vector<ClaimCase> open_cases(const Model& model);

/// Evaluates the claims in all cases and determines which settings decide them. The claims must be
/// those of check_claims() with the same gains. The result does not depend on the number of cores.
void add_open_cases(const Model& model, const std::optional<Gains<double>>& gains,
                    const BatchArithmetic& arithmetic, std::vector<Claim>& claims,
                    const Progress& progress = {});

/// Settings that decide the verdict, the most decisive first: "wheel_force (8 of 12)" means that
/// changing only this setting changes the verdict in 8 of 12 combinations. Empty if no setting
/// changes it.
std::string decisive_settings(const std::vector<ClaimCase>& cases);

}  // namespace awmr
