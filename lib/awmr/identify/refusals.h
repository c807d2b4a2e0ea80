/// Requested parameters that the data do not identify. Private to identify/.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "awmr/identify/options.h"
#include "awmr/model/model.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// The requested parameters; if none are named, those that the given trials measure.
std::vector<ParameterId> requested_parameters(const Vehicle& vehicle, const TrialData& data,
                                              const IdentifyOptions& options);

/// Reason why a parameter has no value although its trials are present.
struct Reasons {
  std::string surge;         ///< why no fit of the surge rows is accepted
  std::string turning;       ///< the same for the turning rows
  std::string mass;          ///< why the coast-downs give no m'
  bool curve_alone = false;  ///< curves without a surge law: `mass` is also the reason for the
                             ///< missing a1
  /// Fitted, but not finite or outside the range of a model file.
  std::map<ParameterId, std::string> inadmissible;
  std::map<ParameterId, std::string> logs;  ///< free in the fit of the logs, but not identifiable
};

/// Marks parameters without a value as not identified, with the reason; for requested ones the
/// finding is an error (`not-identifiable`). Parameters that the vehicle does not have get no
/// finding. A given or assumed value is kept; a finding reports if a log was to identify it and did
/// not. Returns the requested parameters that are refused.
std::vector<ParameterId> refuse_what_is_missing(const TrialData& data, const Reasons& reasons,
                                                const std::vector<ParameterId>& requested,
                                                Model& model);

}  // namespace awmr
