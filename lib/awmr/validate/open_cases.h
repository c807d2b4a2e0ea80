/// Evaluates the paper's claims for all combinations ("cases") of settings that the paper does not
/// give. Private to validate/.
///
/// The paper prints neither the limits of the wheel force F' nor how the combined mode divides the
/// yaw moment at a limit. Its allocation is an approximation for small steering angles. With its
/// m', the largest thrust needs more tyre force than friction permits. The cases combine
///
///     allocation   exact, paper (control/allocation.h)
///     F'           [-1, 1], [0, 1] (the paper's own normalisation), [0, 0.5]
///     m', I'z      as in the model, and multiplied so that tau_speed = 2 needs a friction of 0.8:
///                  2 F_max <= 0.8 m g with F_max = m/m'  =>  m' >= 2/(0.8 g)
///     split        redistribute, fixed half
#pragma once

#include <optional>
#include <vector>

#include "awmr/core/progress.h"
#include "awmr/validate/claims.h"

namespace awmr {

/// Returns all combinations. If the model's m' already is at least 2/(0.8 g), m' and I'z are not
/// varied.
std::vector<ClaimCase> open_cases(const Model& model);

/// Adds to each claim its verdict in all cases, and the settings on which the verdict depends.
/// `claims` must be the result of check_claims() with the same gains. The result does not depend on
/// the number of cores.
void add_open_cases(const Model& model, const std::optional<ModeGains>& gains,
                    const BatchArithmetic& arithmetic, std::vector<Claim>& claims,
                    const Progress& progress = {});

/// Lists the settings on which the verdict depends, most decisive first. "wheel_force (8 of 12)"
/// means: there are 12 combinations of all settings except wheel_force; in 8 of them, a change of
/// wheel_force alone changes the verdict. Empty if the verdict is the same in all cases.
std::string decisive_settings(const std::vector<ClaimCase>& cases);

}  // namespace awmr
