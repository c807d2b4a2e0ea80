/// Trials and logs -> Model: fits, derived quantities, uncertainty, identifiability.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/options.h"
#include "awmr/model/model.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

struct Identification {
  Model model;
  std::vector<ParameterId> refused;  ///< requested, but not identifiable: exit code 1
};

/// Errors (input): contradictory options, such as a robust loss with the log-linear method. A
/// parameter that the data cannot identify is not an error: it has no value and a
/// `not-identifiable` finding, and it is in `refused`.
Result<Identification> identify(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options, std::vector<Finding> findings);

/// The same for trials from load_trials(); their findings come first in the record.
Result<Identification> identify(const Trials& trials, const IdentifyOptions& options);

/// Factor from the assumed sway resistance (`assumed-sway`) to each end of its 95 % range, > 1.
/// Uncertainty of m' is not included.
double assumed_sway_factor();

}  // namespace awmr
