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
  std::vector<ParameterId> refused;  ///< required parameters that the data do not identify
  bool has_refused_terms = false;  ///< true: the logs do not identify one of IdentifyOptions::terms
};

/// Identifies the model of a vehicle. `findings`: findings from reading the data, which come first
/// in the model's record. If the data do not identify a parameter, this is not an error: the
/// parameter gets no value and the finding `not-identifiable`. `refused` lists it if the user
/// requested it or the data should measure it (refuse_what_is_missing() in refusals.h). Errors
/// (input): contradictory options, such as a robust loss with the log-linear method; an option
/// without the trials that it needs; a requested parameter or family that the vehicle cannot have;
/// back-EMF, given or requested, together with a surge or turning table; and the errors of
/// run_log_stage() (log_stage.h).
Result<Identification> identify(const Vehicle& vehicle, const TrialData& data,
                                const IdentifyOptions& options, std::vector<Finding> findings);

/// Identifies the model from trials that load_trials() has read. Errors: those of the function
/// above.
Result<Identification> identify(const Trials& trials, const IdentifyOptions& options);

/// Uncertainty of the assumed sway resistance (`assumed-sway`), as a factor > 1: the 95 % interval
/// is from value/factor to value times factor. Excludes the uncertainty of m'.
double assumed_sway_factor();

}  // namespace awmr
