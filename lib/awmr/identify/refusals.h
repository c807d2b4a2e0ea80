/// Requested parameters that the data do not identify. Private to identify/.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "awmr/identify/options.h"
#include "awmr/model/model.h"
#include "awmr/trials/trial_data.h"

namespace awmr {

/// The parameters requested: those named, else those that the given trials exist for.
std::vector<ParameterId> requested_parameters(const Vehicle& vehicle, const TrialData& data,
                                              const IdentifyOptions& options);

/// Reason why a parameter has no value although its trials are present.
struct Reasons {
  std::string surge;         ///< why no fit of the surge rows will do, although they show a law
  std::string turning;       ///< the same of the turning rows
  std::string mass;          ///< why the coast-downs give no m'
  bool curve_alone = false;  ///< curves without a surge law: `mass` is why a1 is missing, too
  /// Fitted, but not finite or outside of the range of a model.
  std::map<ParameterId, std::string> inadmissible;
  std::map<ParameterId, std::string> logs;  ///< free in the fit of the logs, but not identifiable
};

/// Marks parameters without a value as not identified, with the reason; for requested ones the
/// finding is an error (`not-identifiable`). Parameters that the vehicle does not have get no
/// finding. A given or assumed value is kept; if a log should have identified it and did not, that
/// is reported. Returns what was requested and refused.
std::vector<ParameterId> refuse_what_is_missing(const TrialData& data, const Reasons& reasons,
                                                const std::vector<ParameterId>& requested,
                                                Model& model);

}  // namespace awmr
