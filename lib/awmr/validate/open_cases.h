/// What the paper leaves open, and what its claims hang on. Private to this folder.
///
/// The paper prints neither the limits of F' nor a way to share the moment of the combined mode, its
/// allocation is for small angles, and its m' asks more of the tyres than they carry. The cases are
/// all combinations of
///
///     allocation   exact, paper (control/allocation.h)
///     F'           [-1, 1], [0, 1] (the paper's own normalisation), [0, 0.5]
///     m', I'z      times 1, and times what puts tau_speed = 2 within a friction of 0.8:
///                  2 F_max <= 0.8 m g with F_max = m/m'  =>  m' >= 2/(0.8 g)
///     split        redistribute, fixed half
#pragma once

#include <optional>
#include <vector>

#include "awmr/core/progress.h"
#include "awmr/validate/claims.h"

namespace awmr {

/// Every combination; the mass factor 1 alone where the model's own m' is within the friction.
std::vector<ClaimCase> open_cases(const Model& model);

/// Puts the cases into the claims, which have to be those of check_claims() with the same gains, and
/// says which settings decide them. The result does not depend on the number of cores.
void add_open_cases(const Model& model, const std::optional<Gains<double>>& gains,
                    const BatchArithmetic& arithmetic, std::vector<Claim>& claims,
                    const Progress& progress = {});

/// The settings on which the verdict hangs, the most decisive first: "wheel_force (8 of 12)" is a
/// setting whose change alone turns the verdict in 8 of 12 places. Empty where nothing turns it.
std::string decisive_settings(const std::vector<ClaimCase>& cases);

}  // namespace awmr
