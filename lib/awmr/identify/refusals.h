/// Refusal of parameters that the data do not identify, with the reason. Private to identify/.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "awmr/identify/options.h"
#include "awmr/model/model.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// Parameters that the user requested or, if `options` name none, those that the trials measure.
std::vector<ParameterId> requested_parameters(const Vehicle& vehicle, const TrialData& data,
                                              const IdentifyOptions& options);

/// Reasons why parameters have no value although trials that measure them were recorded.
struct Reasons {
  std::string surge;    ///< why no fit of the surge rows is accepted; empty otherwise
  std::string turning;  ///< why no fit of the turning rows is accepted; empty otherwise
  std::string mass;     ///< why stop times or curves give no m'; empty otherwise
  /// True if coast-down curves were fitted without a surge trial. `mass` is then also the reason
  /// why a1 has no value.
  bool curve_alone = false;
  /// For each removed parameter: why its fitted value was removed (take_out_inadmissible()).
  std::map<ParameterId, std::string> inadmissible;
  /// For each parameter that the logs do not identify: the reason.
  std::map<ParameterId, std::string> logs;
};

/// Adds the finding `not-identifiable` for every parameter of the vehicle that has no value. Adds
/// it also for a requested parameter that has a given or assumed value but is not identified by the
/// logs; the model keeps that value. The finding is an error if the parameter is required, else a
/// note. Required are the parameters that `options` name. If they name none, a parameter is
/// required if a table measures it, or if a log measures it and vehicle.json does not give it; the
/// sway resistance is then never required. Returns the required parameters that the data do not
/// identify.
std::vector<ParameterId> refuse_what_is_missing(const TrialData& data, const Reasons& reasons,
                                                const std::vector<ParameterId>& requested,
                                                const IdentifyOptions& options, Model& model);

}  // namespace awmr
