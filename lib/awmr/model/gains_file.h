/// gains.json (`awmr.gains/1`): the gains a later command needs. tune/ writes the rest of the file.
#pragma once

#include <filesystem>

#include "awmr/core/result.h"
#include "awmr/model/gains.h"

namespace awmr {

/// The gains printed in the paper: lambda 3, mu 50, epsilon 12.                         [paper 4.1]
/// It prints no mu_s and epsilon_s. Those here, 5 and 1.2, are this project's: their ratio is that
/// of the heading loop's mu and epsilon.
inline constexpr Gains<double> kPaperGains{{3.0, 50.0, 12.0}, {5.0, 1.2}};

/// Reads `/heading` and `/speed`. The file's other keys are allowed and not looked at.
/// Errors: as read_json_file; a gain that is missing, unknown or not above 0.
Result<Gains<double>> read_gains(const std::filesystem::path& path);

}  // namespace awmr
