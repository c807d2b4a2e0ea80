/// gains.json (`awmr.gains/1`): the gains a later command needs. tune/ writes the rest of the file.
#pragma once

#include <filesystem>

#include "awmr/core/result.h"
#include "awmr/model/gains.h"

namespace awmr {

/// The gains printed in the paper; it prints no mu_s, epsilon_s, so the speed loop's are this
/// project's: the same ratio mu/epsilon as the heading loop's.                          [paper 4.1]
inline constexpr Gains<double> kPaperGains{{3.0, 50.0, 12.0}, {5.0, 1.2}};

/// Reads `/heading` and `/speed`; the contract's other keys are allowed and passed over.
Result<Gains<double>> read_gains(const std::filesystem::path& path);

}  // namespace awmr
