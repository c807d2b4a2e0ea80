/// Identification of a Model from trials and logs, with intervals. Public interface of identify/.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/identify/options.h"
#include "awmr/model/model.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

struct Identification {
  Model model;
  std::vector<ParameterId> refused;  ///< requested parameters that the data do not identify
};

/// Identifies the model of a vehicle. `findings`: those of the data, put first in the record.
/// Errors (input): contradictory options, such as a robust loss with the log-linear method; an
/// option without the trials that it needs; a requested parameter or family that the vehicle cannot
/// have; back-EMF together with tables; as run_log_stage() (log_stage.h).
/// A parameter that the data do not identify is not an error: it gets no value and the finding
/// `not-identifiable`, and is listed in `refused` if it was requested.
Result<Identification> identify(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options, std::vector<Finding> findings);

/// Identifies the model from trials that load_trials() has read. Errors: as above.
Result<Identification> identify(const Trials& trials, const IdentifyOptions& options);

/// Ratio of the upper end of the 95 % interval of the assumed sway resistance (`assumed-sway`) to
/// its value, and of its value to the lower end; > 1. Excludes the uncertainty of m'.
double assumed_sway_factor();

}  // namespace awmr
